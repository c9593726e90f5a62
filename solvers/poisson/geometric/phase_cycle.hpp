// The levels below the finest one for two phases of very different density, and one cycle on them: aggregates of phase_aggregates.hpp,
// restriction by sums, prolongation of constants, half of the Galerkin weights (the over-correction of hierarchy.hpp). The cycle is a
// symmetric W(1,1): it takes half the iterations of a V-cycle where many components straddle the sides of coarse cells.
#pragma once
#include "poisson/geometric/level.hpp"
#include "poisson/geometric/phase_aggregates.hpp"
#include "poisson/matrix/sparse_cholesky.hpp"

namespace weir::poisson {

template <int D>
class PhaseCycle {
public:
    /// `plan`: the levels of the geometric hierarchy, whose coarsened axes these levels share.
    void build(const Natural<D>& problem, const LightComponents& light, const std::vector<Level<D>>& plan);
    /// The unknown of each cell, −1 outside fluid.
    const std::vector<int>& of_cells() const { return of_cells_.of; }
    /// Right-hand side of the first level, which the caller fills, and the result of apply().
    Vector& rhs() { return levels_.front().b; }
    const Vector& solution() const { return levels_.front().x; }
    /// One symmetric cycle from zero.
    void apply() { cycle(0); }
    /// Unknowns of a level, 0: below the cells.
    int unknowns(std::size_t level) const { return levels_[level].A.size(); }
    std::size_t levels() const { return levels_.size(); }
    std::size_t bytes() const;

private:
    struct CoarseLevel {
        PhaseUnknowns<D> unknowns;
        Matrix A;
        Aggregation groups;  // to the next level
        Vector inverse;      // of the diagonal
        Vector x, b;
    };
    void build_first(const Natural<D>& problem, const LightComponents& light, const Level<D>& finest);
    CoarseLevel below(CoarseLevel& fine, const LightComponents& light, const Level<D>& plan) const;
    void cycle(std::size_t l);
    void correct(std::size_t l);
    void solve_coarsest();

    Aggregation of_cells_;
    std::vector<CoarseLevel> levels_;
    SparseCholesky coarsest_;
    Components coarsest_components_;
    ComponentFinder finder_;
};

}  // namespace weir::poisson
