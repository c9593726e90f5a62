#include "poisson/geometric/two_phase.hpp"

namespace weir::poisson {

namespace {

/// Clusters of the lighter phase from which the geometric cycle is not tried. Each is one small eigenvalue, which conjugate gradients
/// remove in about one iteration.
constexpr int cloud = 12;

}  // namespace

template <int D>
void TwoPhase<D>::setup(const Operator<D>& A, const Natural<D>& problem) {
    ready_ = false;
    distributed_ = problem.own().distributed();
    two_phases_ = !A.light.empty() && !A.weight[0].empty();
    if (!two_phases_) return;
    if (!distributed_) {
        cells_ = find_phase_cells(problem, A.light.data());
        return;
    }
    Grid<std::uint8_t, D> light = A.light;
    gather(light);
    whole_.build(problem.as_operator(), OwnPlanes());
    cells_ = find_phase_cells(whole_, light.data());
    if (!is_cloud()) whole_ = {};  // rarely needed again
}

template <int D>
bool TwoPhase<D>::is_cloud() const {
    return two_phases_ && cells_.light_clusters >= cloud;
}

template <int D>
void TwoPhase<D>::prepare(const Natural<D>& problem, Hierarchy<D>& hierarchy) {
    if (ready_) return;
    if (distributed_) {
        if (!is_cloud()) whole_.build(problem.as_operator(), OwnPlanes());
        whole_hierarchy_.build(whole_);
    }
    cg_.setup(distributed_ ? whole_ : problem, distributed_ ? whole_hierarchy_ : hierarchy, cells_);
    ready_ = true;
}

template <int D>
bool TwoPhase<D>::solve(Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report) {
    if (!distributed_) return cg_.solve(p, b, options, report);
    Grid<real, D> whole_b = b;
    gather(p);
    gather(whole_b);
    const bool solved = cg_.solve(p, whole_b, options, report);
    p.store().close();
    return solved;
}

template <int D>
std::size_t TwoPhase<D>::bytes() const {
    return two_phases_ ? cells_.bytes() + whole_.bytes() + (ready_ ? whole_hierarchy_.bytes() + cg_.bytes() : 0) : 0;
}

template class TwoPhase<2>;
template class TwoPhase<3>;

}  // namespace weir::poisson
