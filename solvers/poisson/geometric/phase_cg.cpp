#include "poisson/geometric/phase_cg.hpp"

#include "poisson/geometric/packing.hpp"
#include "poisson/geometric/v_cycle.hpp"

namespace weir::poisson {

namespace {

/// Iterations before the next method takes over; each takes a sixth of one of the pairwise aggregation's.
constexpr int worth_while = 64;

}  // namespace

template <int D>
void PhaseCg<D>::setup(const Natural<D>& problem, Hierarchy<D>& hierarchy, const PhaseCells<D>& cells) {
    problem_ = &problem, hierarchy_ = &hierarchy;
    coarse_.build(problem, cells, hierarchy.levels());
    const std::size_t size = cells.unknowns.box.size();
    for (Vector* v : {&r_, &p_, &Ap_, &zero_}) v->assign(size, 0);
    z_.assign(size, 0);
    for (Vector* v : {&rz_, &zAp_}) v->assign(static_cast<std::size_t>(problem.planes()), 0);
    number_red_cells();
}

/// unknown_[row × width + m]: the coarse unknown of entry m of a red row.
template <int D>
void PhaseCg<D>::number_red_cells() {
    const Layout<D>& at = hierarchy_->finest().at;
    const auto width = static_cast<std::size_t>(at.width);
    unknown_.assign(static_cast<std::size_t>(at.rows()) * width, -1);
    red_.assign(unknown_.size(), 0);
    for (int q = 0; q < at.planes(); ++q)
        for (int j = 0; j < at.rows_in_plane(); ++j) {
            const auto row = static_cast<std::size_t>(at.row(q, j));
            const int* of = coarse_.of_cells().data() + row * static_cast<std::size_t>(at.n[0]);
            for (int i = at.parity(q, j), m = 0; i < at.n[0]; i += 2, ++m) unknown_[row * width + static_cast<std::size_t>(m)] = of[i];
        }
}

template <int D>
template <class F>
real PhaseCg<D>::sum_of_rows(F&& f) const {
    return plane_sum(OwnPlanes(), problem_->planes(), [&](int q) {
        real sum = 0;
        for (int j = 0; j < problem_->rows_in_plane(); ++j) {
            const int row = problem_->row(q, j), n = problem_->extent()[0];
            if (!problem_->is_dry(row)) sum += f(static_cast<std::size_t>(row) * static_cast<std::size_t>(n), static_cast<std::size_t>(n));
        }
        return sum;
    });
}

/// Smooths from zero, and restricts the residual of the red cells.
template <int D>
void PhaseCg<D>::smooth_down() {
    Level<D>& finest = hierarchy_->finest();
    const Layout<D>& at = finest.at;
    const auto width = static_cast<std::size_t>(at.width), n = static_cast<std::size_t>(at.n[0]);
    const auto work = [&](int stage, int q) {
        if (stage > 0 && stage < 4) return relax_plane(finest, q, stage == 2 ? 0 : 1);
        for (int j = 0; j < at.rows_in_plane(); ++j) {
            const auto row = static_cast<std::size_t>(at.row(q, j)), s = static_cast<std::size_t>(at.parity(q, j));
            const std::ptrdiff_t own = at.offset(at.row(q, j));
            if (stage == 0) {
                split(r_.data() + row * n, at.n[0], at.width, finest.r[s] + own, finest.r[1 - s] + own);
                continue;
            }
            float* t = scratch_row(at.stride + 2 * lanes);
            std::fill_n(t, at.stride + lanes, 0.0f);
            add_red_residual(finest, q, j, t);
            std::copy_n(t, width, red_.data() + row * width);
        }
        if (stage == 0) start_plane(finest, q);
    };
    VCycle<D>::run(finest, VCycle<D>::wavefront(finest, 5, false), work, [](int) {});
    Vector& rhs = coarse_.rhs();
    std::fill(rhs.begin(), rhs.end(), 0.0);
    for (std::size_t k = 0; k < unknown_.size(); ++k)
        if (unknown_[k] >= 0) rhs[static_cast<std::size_t>(unknown_[k])] += red_[k];
}

/// Adds the coarse correction to the red cells, and smooths; z is the result.
template <int D>
void PhaseCg<D>::smooth_up() {
    Level<D>& finest = hierarchy_->finest();
    const Layout<D>& at = finest.at;
    const Vector& correction = coarse_.solution();
    const auto width = static_cast<std::size_t>(at.width), n = static_cast<std::size_t>(at.n[0]);
    const auto work = [&](int stage, int q) {
        if (stage > 0 && stage < 5) return relax_plane(finest, q, stage % 2 == 1 ? 1 : 0);
        for (int j = 0; j < at.rows_in_plane(); ++j) {
            const auto row = static_cast<std::size_t>(at.row(q, j)), s = static_cast<std::size_t>(at.parity(q, j));
            const std::ptrdiff_t own = at.offset(at.row(q, j));
            if (stage == 5) {
                if (!problem_->is_dry(at.row(q, j))) {
                    merge(finest.u[s] + own, finest.u[1 - s] + own, at.n[0], z_.data() + row * n);
                    add_products(static_cast<std::size_t>(q), row * n, n);
                }
                continue;
            }
            const int* unknown = unknown_.data() + row * width;
            float* u = finest.u[0] + own;
            for (std::size_t m = 0; m < width; ++m)
                if (unknown[m] >= 0) u[m] += static_cast<float>(correction[static_cast<std::size_t>(unknown[m])]);
            at.wrap(u);
        }
    };
    VCycle<D>::run(finest, VCycle<D>::wavefront(finest, 6, false), work, [](int) {});
}

/// Adds r·z and z·A p of a row to those of its plane.
template <int D>
void PhaseCg<D>::add_products(std::size_t plane, std::size_t first, std::size_t n) {
    real rz = 0, zAp = 0;
#pragma omp simd reduction(+ : rz, zAp)
    for (std::size_t i = first; i < first + n; ++i) rz += r_[i] * z_[i], zAp += z_[i] * Ap_[i];
    rz_[plane] += rz, zAp_[plane] += zAp;
}

template <int D>
real PhaseCg<D>::precondition() {
    std::fill(rz_.begin(), rz_.end(), 0.0);
    std::fill(zAp_.begin(), zAp_.end(), 0.0);
    smooth_down();
    coarse_.apply();
    smooth_up();
    return plane_sum(OwnPlanes(), problem_->planes(), [&](int q) { return rz_[static_cast<std::size_t>(q)]; });
}

template <int D>
void PhaseCg<D>::update_direction(real beta) {
    for_each_block(p_.size(), [&](std::size_t begin, std::size_t end) {
        if (beta == 0)
            for (std::size_t i = begin; i < end; ++i) p_[i] = z_[i];
        else
            for (std::size_t i = begin; i < end; ++i) p_[i] = z_[i] + beta * p_[i];
    });
}

template <int D>
real PhaseCg<D>::flexible_beta(const linear::Step& last) {
    return -plane_sum(OwnPlanes(), problem_->planes(), [&](int q) { return zAp_[static_cast<std::size_t>(q)]; }) / last.pAp;
}

template <int D>
real PhaseCg<D>::multiply() {
    return plane_sum(OwnPlanes(), problem_->planes(), [&](int q) {
        real sum = 0;
        for (int j = 0; j < problem_->rows_in_plane(); ++j) {
            const int row = problem_->row(q, j);
            if (problem_->is_dry(row)) continue;
            const auto n = static_cast<std::size_t>(problem_->extent()[0]), first = static_cast<std::size_t>(row) * n;
            real* Ap = Ap_.data() + first;
            problem_->residual_row(q, j, p_.data(), zero_.data(), Ap);
#pragma omp simd reduction(+ : sum)
            for (std::size_t i = 0; i < n; ++i) Ap[i] = -Ap[i], sum += p_[first + i] * Ap[i];
        }
        return sum;
    });
}

template <int D>
real PhaseCg<D>::advance(real alpha) {
    real* x = x_->data();
    const real rr = sum_of_rows([&](std::size_t first, std::size_t n) {
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (std::size_t i = first; i < first + n; ++i) {
            x[i] += alpha * p_[i];
            r_[i] -= alpha * Ap_[i];
            sum += r_[i] * r_[i];
        }
        return sum;
    });
    return std::sqrt(rr) / b_norm_;
}

/// r = b − A p with the compatible b; returns its norm relative to b.
template <int D>
real PhaseCg<D>::find_residual(const Grid<real, D>& p, const Grid<real, D>& b) {
    problem_->find_means(b);
    for_each_plane(OwnPlanes(), 0, problem_->planes(), [&](int q) {
        for (int j = 0; j < problem_->rows_in_plane(); ++j) {
            const auto n = static_cast<std::size_t>(problem_->extent()[0]), row = static_cast<std::size_t>(problem_->row(q, j));
            problem_->residual_row(q, j, p.data(), b.data(), r_.data() + row * n);
        }
    });
    b_norm_ = problem_->norm(b);
    problem_->clear_means();
    const real rr = sum_of_rows([&](std::size_t first, std::size_t n) {
        real sum = 0;
        for (std::size_t i = first; i < first + n; ++i) sum += r_[i] * r_[i];
        return sum;
    });
    return b_norm_ > 0 ? std::sqrt(rr) / b_norm_ : 0;
}

template <int D>
bool PhaseCg<D>::solve(Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report) {
    problem_->clean(p);
    x_ = &p;
    real relative = find_residual(p, b);
    if (relative > 1) p.fill(0), relative = find_residual(p, b);
    if (report.iterations == 0) report.residual_before = relative;
    Options limited = options;
    if (!options.fixed_iterations) limited.max_iterations = std::min(options.max_iterations, report.iterations + worth_while);
    linear::StopTest stop = stop_test(limited, report);
    for (int before = -1; stop.wants_more(relative) && report.iterations != before;) {  // anew where the recursive r was too small
        before = report.iterations;
        linear::conjugate_gradients(*this, stop, relative);
        relative = find_residual(p, b);
    }
    report.residual_after = relative;
    report.residual_max = 0;
    for (const real r : r_) report.residual_max = std::max(report.residual_max, std::abs(r));
    problem_->find_means(p);
    problem_->subtract_means(p);
    return relative <= options.tolerance || options.fixed_iterations;
}

template <int D>
std::size_t PhaseCg<D>::bytes() const {
    std::size_t sum = coarse_.bytes() + unknown_.capacity() * sizeof(int) + (red_.capacity() + z_.capacity()) * sizeof(float);
    for (const Vector* v : {&r_, &p_, &Ap_, &zero_}) sum += v->capacity() * sizeof(real);
    return sum;
}

template class PhaseCg<2>;
template class PhaseCg<3>;

}  // namespace weir::poisson
