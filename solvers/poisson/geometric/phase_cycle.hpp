// The levels below the finest one for two phases of very different density, and one cycle on them: aggregates of phase_aggregates.hpp,
// restriction by sums, prolongation of constants, half of the Galerkin weights (the over-correction of hierarchy.hpp). The cycle is a
// symmetric W(1,1): it takes half the iterations of a V-cycle where many components straddle the sides of coarse cells.
#pragma once
#include "poisson/geometric/level.hpp"
#include "poisson/geometric/phase_matrix.hpp"
#include "poisson/matrix/sparse_cholesky.hpp"

namespace weir::poisson {

/// The rows of a matrix, of which the entries before and behind the diagonal are summed apart.
class SplitRows {
public:
    SplitRows() = default;
    explicit SplitRows(const Matrix& A);
    /// Σ w x over earlier and over later unknowns than i.
    real earlier(const Vector& x, std::size_t i) const { return sum(x, start_[i], middle_[i]); }
    real later(const Vector& x, std::size_t i) const { return sum(x, middle_[i], start_[i + 1]); }
    std::size_t bytes() const {
        return (start_.capacity() + middle_.capacity() + column_.capacity()) * sizeof(int) + weight_.capacity() * sizeof(float);
    }

private:
    real sum(const Vector& x, int begin, int end) const {
        real sum = 0;
        for (int k = begin; k < end; ++k)
            sum +=
                static_cast<real>(weight_[static_cast<std::size_t>(k)]) * x[static_cast<std::size_t>(column_[static_cast<std::size_t>(k)])];
        return sum;
    }
    std::vector<int> start_{0}, middle_, column_;
    std::vector<float> weight_;
};

template <int D>
class PhaseCycle {
public:
    /// `plan`: the levels of the geometric hierarchy, whose coarsened axes these levels share.
    void build(const Natural<D>& problem, const PhaseCells<D>& cells, const std::vector<Level<D>>& plan);
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
        SplitRows rows;      // of A
        Vector inverse;      // of the diagonal
        Vector x, b, later;  // later: Σ w x over later unknowns, as it was before the upward sweep
        void sweep_up();
        void sweep_down();
    };
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
