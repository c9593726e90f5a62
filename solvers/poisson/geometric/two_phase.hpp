// When and on which arrays multigrid solves for two phases with aggregates by phase.
#pragma once
#include "poisson/geometric/phase_cg.hpp"

namespace weir::poisson {

template <int D>
class TwoPhase {
public:
    /// Reads the phases of an operator; none where A.light is empty. In parallel, all ranks find the clusters of all planes.
    void setup(const Operator<D>& A, const Natural<D>& problem);
    /// Returns whether the matrix has two phases.
    bool any() const { return two_phases_; }
    /// Returns whether the lighter phase is a cloud: so many clusters that the geometric cycle would be slow. Bubbles are, and a thin film
    /// that is not level.
    bool is_cloud() const;
    /// Builds the aggregates by phase, once after each setup(); in parallel, replicated on each rank.
    void prepare(const Natural<D>& problem, Hierarchy<D>& hierarchy);
    /// Continues from p, after prepare(). Returns false if the tolerance was not reached.
    bool solve(Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report);
    std::size_t bytes() const;

private:
    bool two_phases_ = false, ready_ = false, distributed_ = false;
    PhaseCells<D> cells_;
    Natural<D> whole_;  // in parallel: all planes; empty while the geometric cycle solves
    Hierarchy<D> whole_hierarchy_;
    PhaseCg<D> cg_;
};

}  // namespace weir::poisson
