#include "poisson/matrix/list_solver.hpp"

#include "core/error.hpp"

namespace weir::poisson {

void judge(const Options& options, Report& report) {
    report.converged = report.residual_after <= options.tolerance;
    if (std::isfinite(report.residual_after) && (report.converged || options.fixed_iterations)) return;
    linear::fail("pressure", "pressure solve", {report.residual_after, false}, report.iterations, options.tolerance);
}

void check_extents(bool same, const char* what) {
    if (!same) throw BadInput(std::string("pressure solve: ") + what + " does not have the extent of the cells given to setup()");
}

template <int D>
void ListSolver<D>::setup(const Operator<D>& A) {
    const Stopwatch watch;
    extent_ = A.cells.extent();
    system_.build(A, zero_);
    const auto n = static_cast<std::size_t>(system_.A.size());
    for (Vector* v : {&x_, &b_, &r_}) v->assign(n, 0);
    prepare();
    if (options_.record_history) report_.history.reserve(static_cast<std::size_t>(options_.max_iterations));
    report_.components = system_.components.closed;
    report_.bytes = bytes();
    report_.setup_seconds = watch.seconds();
}

template <int D>
real ListSolver<D>::true_residual() {
    residual(system_.A, x_, b_, r_);
    return b_norm_ == 0 ? 0 : std::sqrt(dot(r_, r_)) / b_norm_;
}

template <int D>
const Report& ListSolver<D>::continue_solve(const Report& attempt, Grid<real, D>& p, const Grid<real, D>& b) {
    const Stopwatch watch;
    check_extents(p.extent() == extent_, "p");
    check_extents(b.extent() == extent_, "b");
    for (std::size_t i = 0; i < x_.size(); ++i) {
        x_[i] = p[static_cast<std::size_t>(system_.cell[i])];
        b_[i] = b[static_cast<std::size_t>(system_.cell[i])];
    }
    system_.components.remove_means(b_);
    b_norm_ = std::sqrt(dot(b_, b_));
    if (b_norm_ == 0 || true_residual() > 1) std::fill(x_.begin(), x_.end(), 0.0);
    report_.iterations = attempt.iterations;
    report_.history = attempt.history;
    report_.residual_before = report_.residual_after = true_residual();
    if (attempt.iterations > 0) report_.residual_before = attempt.residual_before;
    linear::StopTest stop = stop_test(options_, report_);
    while (b_norm_ > 0 && stop.wants_more(report_.residual_after)) {
        const int before = report_.iterations;
        iterate(stop, report_.residual_after);
        report_.residual_after = true_residual();
        if (report_.iterations == before) break;  // no further gain
    }
    system_.components.remove_means(x_);
    p.fill(0);
    for (std::size_t i = 0; i < x_.size(); ++i) p[static_cast<std::size_t>(system_.cell[i])] = x_[i];
    report_.residual_after = true_residual();
    report_.residual_max = 0;
    for (const real r : r_) report_.residual_max = std::max(report_.residual_max, std::abs(r));
    report_.solve_seconds = watch.seconds();
    judge(options_, report_);
    return report_;
}

template <int D>
std::size_t ListSolver<D>::bytes() const {
    return system_.bytes() + own_bytes() + (x_.capacity() + b_.capacity() + r_.capacity()) * sizeof(real);
}

template class ListSolver<2>;
template class ListSolver<3>;

}  // namespace weir::poisson
