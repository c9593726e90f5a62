#include "poisson/geometric/geometric_cg.hpp"

#include "poisson/geometric/packing.hpp"

namespace weir::poisson {

namespace {

/// Reduction of r after which it is recomputed: single precision has a relative error of some 1e-5.
constexpr real replace_counted = 1e-4, replace_weighted = 1e-3;

/// Typical reduction of the residual per iteration.
constexpr real usual_reduction = 0.1;

/// Number of iterations before the convergence rate is judged, and from which it is known well.
constexpr int judged_from = 6, well_known_from = 12;

/// Returns whether the tolerance takes more iterations than another method probably would.
bool is_slow(const Report& report, real norm, real tolerance, const ExpectedIterations& most) {
    if (report.iterations < judged_from) return false;
    const int worth_while = report.iterations < well_known_from ? most.early : most.late;
    const real digits_done = std::log(report.residual_before / norm), digits_wanted = std::log(report.residual_before / tolerance);
    return report.iterations * digits_wanted > worth_while * digits_done;
}

}  // namespace

template <int D>
bool GeometricCg<D>::setup(const Natural<D>& problem) {
    if (!hierarchy_.build(problem)) return false;
    own_ = problem.own();
    const Layout<D>& at = hierarchy_.finest().at;
    const std::size_t entries = at.entries(), skip = static_cast<std::size_t>(at.stride + lanes);
    const std::size_t bytes = 2 * Arena::need<double>(entries) + 2 * Arena::need<float>(entries);
    const bool windowed = !hierarchy_.finest().held.empty();
    if (bytes != arena_.size() || x_[0] == nullptr || windowed != windowed_) {
        windowed_ = windowed;
        arena_.reserve(bytes, windowed);
        for (auto& x : x_) hierarchy_.finest().open(arena_, x = arena_.take<double>(entries) + skip, skip, entries);
        for (auto& p : p_) hierarchy_.finest().open(arena_, p = arena_.take<float>(entries) + skip, skip, entries);
    }
    for (float* p : p_) clear_gaps(hierarchy_.finest(), p);
    sums_.assign(static_cast<std::size_t>(at.planes()), {});
    return true;
}

template <int D>
template <class... Of>
std::array<real, sizeof...(Of)> GeometricCg<D>::totals(Of&&... of) const {
    using Sums = ExactSums<std::array<real, sizeof...(Of)>>;
    auto& part = detail::reduction_scratch(sums_.size());
    const int first = own_.lower(0), last = own_.upper(static_cast<int>(sums_.size()));
    Sums sums;
    std::size_t i = 0;
    const auto add = [&](auto&& quantity) {
        for (int q = first; q < last; ++q) part[static_cast<std::size_t>(q - first)] = quantity(sums_[static_cast<std::size_t>(q)]);
        sums.of(i++).add(std::span<const real>(part).first(static_cast<std::size_t>(last - first)));
    };
    (add(of), ...);
    return sum_of_ranks(own_, sums).value();
}

/// x = p in packed order.
template <int D>
void GeometricCg<D>::gather(const Natural<D>& problem, const Grid<real, D>& p) {
    const Layout<D>& at = hierarchy_.finest().at;
    for_each_plane(problem.own(), 0, at.planes(), [&](int q) {
        for (int j = 0; j < at.rows_in_plane(); ++j) {
            const int row = problem.row(q, j);
            if (problem.is_dry(row)) continue;
            const auto s = static_cast<std::size_t>(at.parity(q, j));
            split(p.data() + static_cast<std::ptrdiff_t>(row) * at.n[0], at.n[0], at.width, x_[s] + at.offset(row),
                  x_[1 - s] + at.offset(row));
        }
    });
}

/// x = 0; returns r·r after the first cycle has begun.
template <int D>
real GeometricCg<D>::begin_at_zero(const Natural<D>& problem, const Grid<real, D>& b) {
    at_zero_ = true;
    VCycle<D>(hierarchy_).down(0, 1, [&](int, int q) {
        residual_plane(problem, nullptr, b, q);
        start_plane(hierarchy_.finest(), q);
    });
    return totals([](const PlaneSums& s) { return s.rr; })[0];
}

/// x = p; returns r·r.
template <int D>
real GeometricCg<D>::begin_at(const Natural<D>& problem, const Grid<real, D>& p, const Grid<real, D>& b) {
    at_zero_ = false;
    gather(problem, p);
    for_each_plane(problem.own(), 0, problem.planes(), [&](int q) { residual_plane(problem, p.data(), b, q); });
    return totals([](const PlaneSums& s) { return s.rr; })[0];
}

/// p = x and r = b − A p, after before(plane); returns r·r. Optionally the next cycle begins in the same sweep.
template <int D>
template <class F>
real GeometricCg<D>::replace_residual(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, bool begin_cycle, F&& before) {
    Level<D>& finest = hierarchy_.finest();
    const auto stages = [&](int stage, int q) {
        if (stage == 0) {
            before(q);
            return scatter_plane(problem, p, q);
        }
        residual_plane(problem, p.data(), b, q);
        if (begin_cycle) start_plane(finest, q);
    };
    const auto exchange = [&](int) {
        if (problem.own().distributed()) refresh(p, finest.at.periodic[D - 1]);
    };
    if (begin_cycle)
        VCycle<D>(hierarchy_).down(0, 2, stages, exchange);
    else
        VCycle<D>::run(finest, VCycle<D>::wavefront(finest, 2, false), stages, exchange);
    at_zero_ = false;
    return totals([](const PlaneSums& s) { return s.rr; })[0];
}

/// The downward half of a cycle for an r that was not computed by an iteration.
template <int D>
void GeometricCg<D>::restart_cycle() {
    VCycle<D>(hierarchy_).down(0, 1, [&](int, int q) { start_plane(hierarchy_.finest(), q); });
}

/// The upward half of the cycle, and γ = r·u, δ = u·A u.
template <int D>
void GeometricCg<D>::finish_cycle() {
    VCycle<D> cycle(hierarchy_);
    cycle.below(0);
    cycle.up(0, 2, [&](int stage, int q) { stage == 0 ? last_half_sweep(q) : black_products(q); });
    const auto [gamma, delta] = totals([](const PlaneSums& s) { return s.ru; }, [](const PlaneSums& s) { return s.uAu; });
    gamma_ = gamma, delta_ = delta;
}

template <int D>
real GeometricCg<D>::iterate_down(real alpha, real beta) {
    const Level<D>& finest = hierarchy_.finest();
    VCycle<D>(hierarchy_)
        .down(
            0, 2, [&](int stage, int q) { stage == 0 ? turn_plane(q, beta) : advance_plane(q, alpha); }, [&](int) { finest.refresh(p_); });
    at_zero_ = false;
    return totals([](const PlaneSums& s) { return s.rr; })[0];
}

template <int D>
bool GeometricCg<D>::solve(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report) {
    problem.find_means(b);
    return solve(problem, p, b, options, report, -1);
}

template <int D>
bool GeometricCg<D>::solve(const Natural<D>& problem, Grid<real, D>& p, Grid<real, D>& b, const Options& options, Report& report,
                           const LowRank& more) {
    problem.clear_means();
    const real b_norm = problem.norm(b);
    problem.clean(p);
    added_.begin(more, hierarchy_.finest().at, b);
    added_.see(p);
    added_.set_rhs();
    const bool solved = solve(problem, p, b, options, report, b_norm);
    added_.end();
    return solved;
}

/// Passes the present x to the low-rank columns.
template <int D>
void GeometricCg<D>::see_answer() {
    if (added_.empty()) return;
    at_zero_ ? added_.see_zero() : added_.see(x_);
}

/// b_norm: ‖b‖, or a negative number if it is not known.
template <int D>
bool GeometricCg<D>::solve(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report,
                           real b_norm) {
    report.iterations = 0;
    report.history.clear();
    bool begun = problem.clean(p);  // whether the cycle for r has begun
    if (problem.own().distributed()) refresh(p, hierarchy_.finest().at.periodic[D - 1]);
    real norm = std::sqrt(begun ? begin_at_zero(problem, b) : begin_at(problem, p, b));
    if (b_norm < 0) b_norm = begun ? norm : problem.norm(b);
    if (norm > b_norm || b_norm == 0) {
        p.fill(0);
        if (!added_.empty()) added_.see_zero(), added_.set_rhs();
        norm = std::sqrt(begin_at_zero(problem, b));
        begun = true;
    }
    if (b_norm == 0) {
        report.residual_before = report.residual_after = report.residual_max = 0;
        return true;
    }
    norm /= b_norm;
    report.residual_before = norm;
    if (!iterate(problem, p, b, options, report, {.norm = norm, .b_norm = b_norm, .begun = begun})) return false;
    if (report.iterations > 0)
        problem.means_from_sums();
    else
        problem.find_means(p);
    problem.subtract_means(p);
    real most = 0;
    for (int q = own_.lower(0); q < own_.upper(static_cast<int>(sums_.size())); ++q)
        most = std::max(most, sums_[static_cast<std::size_t>(q)].largest);
    report.residual_max = largest_of_ranks(own_, most);
    return true;
}

/// The iterations of solve() from a residual r; at the end p is x.
template <int D>
bool GeometricCg<D>::iterate(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report,
                             const Start& start) {
    linear::StopTest stop = stop_test(options, report);
    const real factor = hierarchy_.finest().by_count ? replace_counted : replace_weighted;
    const auto replaced_norm = [&](bool begin_cycle, auto&& before) {
        if (!added_.empty()) added_.set_rhs();
        return std::sqrt(replace_residual(problem, p, b, begin_cycle, before)) / start.b_norm;
    };
    real norm = start.norm, replaced = norm, gamma = 0, alpha = 0, reduction = usual_reduction;
    bool begun = start.begun;
    while (stop.wants_more(norm)) {
        if (!begun) restart_cycle();
        finish_cycle();
        if (!added_.empty()) delta_ += added_.energy(hierarchy_.finest().u);
        const real beta = gamma > 0 ? gamma_ / gamma : 0;
        alpha = gamma_ / (gamma > 0 ? delta_ - beta * gamma_ / alpha : delta_);
        gamma = gamma_;
        if (!(alpha > 0)) {
            if (!options.fixed_iterations) return false;
            see_answer();
            norm = replaced_norm(false, [](int) {});  // converged to round-off before the last iteration
            break;
        }
        const real expected = norm * reduction, before = norm;
        const bool ends = stop.would_end(expected), replaces = ends || expected <= factor * replaced;
        begun = !ends;
        if (!added_.empty()) added_.update_direction(beta);
        if (replaces) {
            see_answer();
            if (!added_.empty()) added_.move(alpha);
            norm = replaced = replaced_norm(begun, [&](int q) { turn_plane(q, beta), move_plane(q, alpha); });
        } else {
            if (!added_.empty()) added_.subtract_product(alpha, hierarchy_.finest().r);
            norm = std::sqrt(iterate_down(alpha, beta)) / start.b_norm;
        }
        reduction = norm / before;
        stop.count(norm);
        const bool gives_up = !options.fixed_iterations && is_slow(report, norm, options.tolerance, most_);
        if (!replaces && (gives_up || norm <= factor * replaced || !stop.wants_more(norm))) {
            see_answer();
            norm = replaced = replaced_norm(false, [](int) {});
            begun = false;
        }
        if (gives_up && norm > options.tolerance) return false;
    }
    report.residual_after = norm;
    return true;
}

template <int D>
void GeometricCg<D>::precondition(const Natural<D>& problem, const Grid<real, D>& r, Grid<real, D>& u) {
    problem.clear_means();
    u.fill(0);
    begin_at_zero(problem, r);
    finish_cycle();
    const Level<D>& finest = hierarchy_.finest();
    for (std::size_t c = 0; c < 2; ++c)
        for (int row = 0; row < finest.at.rows(); ++row)
            for (int m = 0; m < finest.at.width; ++m) x_[c][finest.at.offset(row) + m] = finest.u[c][finest.at.offset(row) + m];
    const Layout<D>& at = finest.at;
    for_each_cell<D>(u.extent(), [&](const Index<D>& I) {
        const int j = D == 2 ? 0 : I[1], q = I[D - 1];
        u(I) = x_[static_cast<std::size_t>((I[0] ^ at.parity(q, j)) & 1)][at.offset(at.row(q, j)) + I[0] / 2];
    });
}

template class GeometricCg<2>;
template class GeometricCg<3>;

}  // namespace weir::poisson
