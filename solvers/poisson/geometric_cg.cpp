#include "poisson/geometric_cg.hpp"

#include "poisson/packing.hpp"
#include "poisson/products.hpp"

namespace weir::poisson {

namespace {

/// Reduction of r after which it is replaced: single precision leaves it wrong by some 1e-5 of what it was.
constexpr real replace_counted = 1e-4, replace_weighted = 1e-3;

/// sum += r·r, largest = max |r|; in the order of the compiler's vectors, whatever the threads.
void add_norms(const real* r, int n, real& sum, real& largest) {
    real rr = 0, most = largest;
#pragma omp simd reduction(+ : rr) reduction(max : most)
    for (int i = 0; i < n; ++i) {
        rr += r[i] * r[i];
        most = std::abs(r[i]) > most ? std::abs(r[i]) : most;
    }
    sum += rr;
    largest = most;
}

/// What an iteration usually leaves of the residual.
constexpr real usual_reduction = 0.1;

/// Iterations before the speed of convergence is judged, and how many in all are still worth their price (open water takes 7 to 12).
constexpr int judged_from = 6, worth_while = 32;

/// Will the tolerance take more iterations than another method is likely to?
bool is_slow(const Report& report, real norm, real tolerance) {
    if (report.iterations < judged_from) return false;
    const real digits_done = std::log(report.residual_before / norm), digits_wanted = std::log(report.residual_before / tolerance);
    return report.iterations * digits_wanted > worth_while * digits_done;
}

}  // namespace

template <int D>
bool GeometricCg<D>::setup(const Natural<D>& problem) {
    if (!hierarchy_.build(problem)) return false;
    const Layout<D>& at = hierarchy_.finest().at;
    const std::size_t entries = at.entries(), skip = static_cast<std::size_t>(at.stride + lanes);
    const std::size_t bytes = 2 * Arena::need<double>(entries) + 2 * Arena::need<float>(entries);
    if (bytes != arena_.size() || x_[0] == nullptr) {
        arena_.reserve(bytes);
        for (auto& x : x_) x = arena_.take<double>(entries) + skip;
        for (auto& p : p_) p = arena_.take<float>(entries) + skip;
    }
    for (float* p : p_) clear_gaps(hierarchy_.finest(), p);
    sums_.assign(static_cast<std::size_t>(at.planes()), {});
    return true;
}

template <int D>
template <class F>
real GeometricCg<D>::total(F&& of) const {
    real sum = 0;
    for (const PlaneSums& plane : sums_) sum += of(plane);
    return sum;
}

/// x = p in packed order.
template <int D>
void GeometricCg<D>::gather(const Natural<D>& problem, const Grid<real, D>& p) {
    const Layout<D>& at = hierarchy_.finest().at;
    parallel_for(0, at.planes(), [&](int q) {
        for (int j = 0; j < at.rows_in_plane(); ++j) {
            const int row = problem.row(q, j);
            if (problem.is_dry(row)) continue;
            const auto s = static_cast<std::size_t>(at.parity(q, j));
            split(p.data() + static_cast<std::ptrdiff_t>(row) * at.n[0], at.n[0], at.width, x_[s] + at.offset(row),
                  x_[1 - s] + at.offset(row));
        }
    });
}

/// p = x in fluid, zero elsewhere; dry rows are zero already.
template <int D>
void GeometricCg<D>::scatter_plane(const Natural<D>& problem, Grid<real, D>& p, int q) {
    const Layout<D>& at = hierarchy_.finest().at;
    for (int j = 0; j < at.rows_in_plane(); ++j) {
        const int row = problem.row(q, j);
        if (problem.is_dry(row)) continue;
        const auto s = static_cast<std::size_t>(at.parity(q, j));
        real* to = p.data() + static_cast<std::ptrdiff_t>(row) * at.n[0];
        merge(x_[s] + at.offset(row), x_[1 - s] + at.offset(row), at.n[0], to);
        problem.clear_outside(row, to);
        problem.sum_row(row, to);
    }
}

/// r = b − A p, packed, with its norms; p may be none, which is zero. The means of the problem must be those of b.
template <int D>
void GeometricCg<D>::residual_plane(const Natural<D>& problem, const real* p, const Grid<real, D>& b, int q) {
    Level<D>& finest = hierarchy_.finest();
    const Layout<D>& at = finest.at;
    thread_local Vector natural;
    natural.resize(static_cast<std::size_t>(at.n[0]) + 1);
    PlaneSums sums;
    for (int j = 0; j < at.rows_in_plane(); ++j) {
        const int row = problem.row(q, j);
        if (problem.is_dry(row)) continue;
        const auto s = static_cast<std::size_t>(at.parity(q, j));
        if (p != nullptr)
            problem.residual_row(q, j, p, b.data(), natural.data());
        else
            problem.rhs_row(row, b.data(), natural.data());
        add_norms(natural.data(), at.n[0], sums.rr, sums.largest);
        split(natural.data(), at.n[0], at.width, finest.r[s] + at.offset(row), finest.r[1 - s] + at.offset(row));
    }
    sums_[static_cast<std::size_t>(q)] = sums;
}

/// x = 0; answers r·r, and has begun the first cycle.
template <int D>
real GeometricCg<D>::begin_at_zero(const Natural<D>& problem, const Grid<real, D>& b) {
    at_zero_ = true;
    VCycle<D>(hierarchy_).down(0, 1, [&](int, int q) {
        residual_plane(problem, nullptr, b, q);
        start_plane(hierarchy_.finest(), q);
    });
    return total([](const PlaneSums& s) { return s.rr; });
}

/// x = p; answers r·r.
template <int D>
real GeometricCg<D>::begin_at(const Natural<D>& problem, const Grid<real, D>& p, const Grid<real, D>& b) {
    at_zero_ = false;
    gather(problem, p);
    parallel_for(0, problem.planes(), [&](int q) { residual_plane(problem, p.data(), b, q); });
    return total([](const PlaneSums& s) { return s.rr; });
}

/// p = x and r = b − A p, after before(plane); answers r·r. If wanted, the next cycle begins in the same sweep.
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
    if (begin_cycle)
        VCycle<D>(hierarchy_).down(0, 2, stages);
    else
        VCycle<D>::wavefront(finest, 2, false).run(VCycle<D>::threads_for(finest), stages);
    at_zero_ = false;
    return total([](const PlaneSums& s) { return s.rr; });
}

/// The way down of a cycle for an r that did not come from an iteration.
template <int D>
void GeometricCg<D>::restart_cycle() {
    VCycle<D>(hierarchy_).down(0, 1, [&](int, int q) { start_plane(hierarchy_.finest(), q); });
}

/// The rest of the cycle, and γ = r·u, δ = u·A u.
template <int D>
void GeometricCg<D>::finish_cycle() {
    VCycle<D> cycle(hierarchy_);
    cycle.below(0);
    cycle.up(0, 2, [&](int stage, int q) { stage == 0 ? last_half_sweep(q) : black_products(q); });
    gamma_ = total([](const PlaneSums& s) { return s.ru; });
    delta_ = total([](const PlaneSums& s) { return s.uAu; });
}

/// The last half sweep over the red cells of a plane. It leaves them no residual, so that their u·A u is u·r.
template <int D>
void GeometricCg<D>::last_half_sweep(int q) {
    Level<D>& finest = hierarchy_.finest();
    d8 ru{};
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        float* u = finest.u[0] + finest.at.offset(row);
        const float* r = finest.r[0] + finest.at.offset(row);
        with_row(finest, q, j, 0, [&](const auto neighbours, const auto diagonal) WEIR_INLINED {
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) {
                    const f16 next = (load16(r + m) + neighbours(m)) * diagonal.inverse(m);
                    store(u + m, next);
                    ru += low(next) * load8(r + m) + high(next) * load8(r + m + 8);
                }
        });
        finest.at.wrap(u);
    }
    auto& sums = sums_[static_cast<std::size_t>(q)];
    sums.ru = sums.uAu = sum(ru);
}

template <int D>
void GeometricCg<D>::black_products(int q) {
    const Level<D>& finest = hierarchy_.finest();
    d8 ru{}, uAu{};
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        const float *u = finest.u[1] + finest.at.offset(row), *r = finest.r[1] + finest.at.offset(row);
        const auto diagonal_at = [&, own = finest.at.offset(row)](int m) {
            return finest.by_count ? to_float(finest.count[1] + own + m) : load16(finest.dinv[1] + own + m);
        };
        with_product(finest, finest.u, q, j, 1, [&](const auto product) WEIR_INLINED {
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) {
                    // Past the end of a periodic row stands its first entry again: it must not count twice.
                    const f16 value = load16(u + m), inside = diagonal_at(m) != f16{} ? value : f16{};
                    const d16 Au = product(m), v = {low(inside), high(inside)}, f = load_wide(r + m);
                    ru += v.lo * f.lo + v.hi * f.hi;
                    uAu += v.lo * Au.lo + v.hi * Au.hi;
                }
        });
    }
    auto& sums = sums_[static_cast<std::size_t>(q)];
    sums.ru += sum(ru);
    sums.uAu += sum(uAu);
}

/// p = u + β p.
template <int D>
void GeometricCg<D>::turn_plane(int q, real beta) {
    const Level<D>& finest = hierarchy_.finest();
    const f16 b = splat(static_cast<float>(beta));
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        for (std::size_t c = 0; c < 2; ++c) {
            const float* u = finest.u[c] + finest.at.offset(row);
            float* p = p_[c] + finest.at.offset(row);
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) store(p + m, load16(u + m) + b * load16(p + m));
            finest.at.wrap(p);
        }
    }
}

/// x += α p for sixteen entries; where x is zero, α p.
WEIR_INLINE void move(double* x, const d16& direction, real alpha, bool from_zero) {
    store8(x, (from_zero ? d8{} : load8(x)) + alpha * direction.lo);
    store8(x + 8, (from_zero ? d8{} : load8(x + 8)) + alpha * direction.hi);
}

/// x += α p,  r −= α A p,  r·r, and the red start of the next cycle.
template <int D>
void GeometricCg<D>::advance_plane(int q, real alpha) {
    Level<D>& finest = hierarchy_.finest();
    const bool from_zero = at_zero_;
    d8 rr{};
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        const std::ptrdiff_t own = finest.at.offset(row);
        for (int colour = 0; colour < 2; ++colour) {
            const auto c = static_cast<std::size_t>(colour);
            double* x = x_[c] + own;
            float* r = finest.r[c] + own;
            const float* p = p_[c] + own;
            with_product(finest, p_, q, j, colour, [&](const auto product) WEIR_INLINED {
                with_row(finest, q, j, colour, [&](const auto&, const auto diagonal) WEIR_INLINED {
                    for (const Span& span : RowSpans<D>(finest, row))
                        for (int m = span.begin; m < span.end; m += lanes) {
                            const d16 Ap = product(m), direction = load_wide(p + m), old = load_wide(r + m);
                            move(x + m, direction, alpha, from_zero);
                            const d8 lo = old.lo - alpha * Ap.lo, hi = old.hi - alpha * Ap.hi;
                            const f16 inside = diagonal.inverse(m) != f16{} ? join(lo, hi) : f16{};
                            store(r + m, inside);
                            const d8 a = low(inside), b = high(inside);
                            rr += a * a + b * b;
                            if (colour == 0) store(finest.u[0] + own + m, inside * diagonal.inverse(m));
                        }
                });
            });
        }
        finest.at.wrap(finest.u[0] + own);
    }
    sums_[static_cast<std::size_t>(q)].rr = sum(rr);
}

template <int D>
real GeometricCg<D>::iterate_down(real alpha, real beta) {
    VCycle<D>(hierarchy_).down(0, 2, [&](int stage, int q) { stage == 0 ? turn_plane(q, beta) : advance_plane(q, alpha); });
    at_zero_ = false;
    return total([](const PlaneSums& s) { return s.rr; });
}

/// x += α p alone.
template <int D>
void GeometricCg<D>::move_plane(int q, real alpha) {
    const Level<D>& finest = hierarchy_.finest();
    const bool from_zero = at_zero_;
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        for (std::size_t c = 0; c < 2; ++c) {
            double* x = x_[c] + finest.at.offset(row);
            const float* p = p_[c] + finest.at.offset(row);
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) move(x + m, load_wide(p + m), alpha, from_zero);
        }
    }
}

template <int D>
bool GeometricCg<D>::solve(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report) {
    problem.find_means(b);
    report.iterations = 0;
    report.history.clear();
    bool begun = problem.clean(p);  // has the cycle for r begun?
    real norm = std::sqrt(begun ? begin_at_zero(problem, b) : begin_at(problem, p, b));
    const real b_norm = begun ? norm : problem.norm(b);
    if (norm > b_norm || b_norm == 0) {
        p.fill(0);
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
    report.residual_max = 0;
    for (const PlaneSums& plane : sums_) report.residual_max = std::max(report.residual_max, plane.largest);
    return true;
}

/// The iterations of solve() from a residual r; p is x at the end.
template <int D>
bool GeometricCg<D>::iterate(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report,
                             const Start& start) {
    Progress progress(options, report);
    const real factor = hierarchy_.finest().by_count ? replace_counted : replace_weighted;
    const auto replaced_norm = [&](bool begin_cycle, auto&& before) {
        return std::sqrt(replace_residual(problem, p, b, begin_cycle, before)) / start.b_norm;
    };
    real norm = start.norm, replaced = norm, gamma = 0, alpha = 0, reduction = usual_reduction;
    bool begun = start.begun;
    while (progress.wants_more(norm)) {
        if (!begun) restart_cycle();
        finish_cycle();
        const real beta = gamma > 0 ? gamma_ / gamma : 0;
        alpha = gamma_ / (gamma > 0 ? delta_ - beta * gamma_ / alpha : delta_);
        gamma = gamma_;
        if (!(alpha > 0)) {
            if (!options.fixed_iterations) return false;
            norm = replaced_norm(false, [](int) {});  // converged to round-off before the iterations were spent
            break;
        }
        const real expected = norm * reduction, before = norm;
        const bool ends = progress.would_end(expected), replaces = ends || expected <= factor * replaced;
        begun = !ends;
        if (replaces)
            norm = replaced = replaced_norm(begun, [&](int q) { turn_plane(q, beta), move_plane(q, alpha); });
        else
            norm = std::sqrt(iterate_down(alpha, beta)) / start.b_norm;
        reduction = norm / before;
        progress.count(norm);
        const bool gives_up = !options.fixed_iterations && is_slow(report, norm, options.tolerance);
        if (!replaces && (gives_up || norm <= factor * replaced || !progress.wants_more(norm))) {
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
