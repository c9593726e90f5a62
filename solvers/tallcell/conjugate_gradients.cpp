// The iteration around the multigrid cycle, in double precision on shared rows.
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "tallcell/column_rows.hpp"
#include "tallcell/multigrid.hpp"

#include <algorithm>
#include <cmath>

namespace weir::tallcell {

namespace {

/// Sum over all entries of f(i), in blocks of one size: no result depends on the number of threads.
template <class F>
real sum_over_entries(std::size_t count, F&& f) {
    constexpr std::size_t block = 8192;
    return ordered_sum(static_cast<int>((count + block - 1) / block), [&](int b) {
        real sum = 0;
        const std::size_t begin = at(b) * block, end = std::min(count, begin + block);
#pragma omp simd reduction(+ : sum)
        for (std::size_t i = begin; i < end; ++i) sum += f(i);
        return sum;
    });
}

/// y = A x, and x·y.
real multiply_and_dot(const ColumnMatrix& A, std::vector<real>& x, std::vector<real>& y) {
    const std::ptrdiff_t row = A.row_stride();
    return ordered_sum(A.n[1], [&](int z) {
        wrap_line(A, z, x.data());
        real dot = 0;
        for (const int parity : {0, 1})
            for (int begin = 0; begin < A.of_parity(parity); begin += lanes) {
                const int count = std::min(lanes, A.of_parity(parity) - begin);
                const Beside to(A, z, parity);
                for (int k = 0; k < A.rows; ++k) {
                    const std::size_t first = A.first(z, k, parity) + at(begin);
                    const real *v = x.data() + first, *c = A.vertical.data() + first;
                    const real *lid = A.lid.data() + first, *sink = A.sink.data() + first;
                    const real *w0 = A.beside[0].data() + first, *w1 = A.beside[1].data() + first;
                    real* sum = y.data() + first;
#pragma omp simd
                    for (int i = 0; i < count; ++i) {
                        const real vertical = c[i] * (v[i] - v[i + row]) + c[i - row] * (v[i] - v[i - row]);
                        const real along_x = w0[i] * (v[i] - v[i + to.x_lower]) + w0[i + to.x_upper] * (v[i] - v[i + to.x_upper]);
                        const real along_z = w1[i] * (v[i] - v[i + to.z_lower]) + w1[i + to.z_upper] * (v[i] - v[i + to.z_upper]);
                        sum[i] = (vertical + (lid[i] + sink[i]) * v[i]) + (along_x + along_z);
                    }
                    if (!A.tall[at(k)]) continue;
                    const real* next = A.sink_next.data() + first;
#pragma omp simd
                    for (int i = 0; i < count; ++i) sum[i] += next[i] * v[i + row] + next[i - row] * v[i - row];
                    for (const std::size_t h : {at(0), at(1)}) {
                        const real* w = A.beside_next[h].data() + first;
                        const std::ptrdiff_t lower = h == 0 ? to.x_lower : to.z_lower, upper = h == 0 ? to.x_upper : to.z_upper;
#pragma omp simd
                        for (int i = 0; i < count; ++i) {
                            const real above = w[i] * (v[i + row] - v[i + lower + row]) + w[i + upper] * (v[i + row] - v[i + upper + row]);
                            const real below =
                                w[i - row] * (v[i - row] - v[i + lower - row]) + w[i + upper - row] * (v[i - row] - v[i + upper - row]);
                            sum[i] += above + below;
                        }
                    }
                }
                gather(A, z, parity, begin, begin + count, y.data());
                for (int k = 0; k < A.rows; ++k) {
                    const std::size_t first = A.first(z, k, parity) + at(begin);
                    const real *v = x.data() + first, *sum = y.data() + first;
#pragma omp simd reduction(+ : dot)
                    for (int i = 0; i < count; ++i) dot += v[i] * sum[i];
                }
            }
        return dot;
    });
}

}  // namespace

/// From values by knots to the shared rows, those inside elements zero.
void ColumnMultigrid::place(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& from, std::vector<real>& to) const {
    const std::size_t stride = at(A.row_stride());
    parallel_for(0, A.n[1], [&](int z) {
        for (int x = 0; x < A.n[0]; ++x) {
            const int c = x + z * A.n[0];
            const std::size_t foot = A.at(x, z, 0);
            int i = knots.start[at(c)];
            const int last = knots.start[at(c) + 1];
            for (int k = 0; k < A.rows; ++k) {
                const bool knot = i < last && knots.row[at(i)] == A.row[at(k)];
                to[foot + at(k) * stride] = knot ? from[at(i++)] : 0;
            }
        }
    });
}

void ColumnMultigrid::fetch(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& from, std::vector<real>& to) const {
    const std::size_t stride = at(A.row_stride());
    parallel_for(0, A.n[1], [&](int z) {
        for (int x = 0; x < A.n[0]; ++x) {
            const int c = x + z * A.n[0];
            const std::size_t foot = A.at(x, z, 0);
            int k = 0;
            for (int i = knots.start[at(c)]; i < knots.start[at(c) + 1]; ++i) {
                while (A.row[at(k)] < knots.row[at(i)]) ++k;
                to[at(i)] = from[foot + at(k) * stride];
            }
        }
    });
}

void ColumnMultigrid::multiply(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& x, std::vector<real>& y) {
    place(A, knots, x, x_);
    interpolate(A, x_);
    multiply_and_dot(A, x_, Ap_);
    fetch(A, knots, Ap_, y);
}

void ColumnMultigrid::precondition(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& r, std::vector<real>& z) {
    real largest = 0;
    for (const real value : r) largest = std::max(largest, std::abs(value));
    place(A, knots, r, r_);
    precondition(A, largest);
    std::copy(levels_[0].x.begin(), levels_[0].x.end(), p_.begin());
    fetch(A, knots, p_, z);
    for (real& value : z) value *= scale_;
}

const poisson::Report& ColumnMultigrid::solve(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& b, std::vector<real>& x) {
    const std::size_t count = A.size();
    report_.history.clear();
    report_.iterations = 0, report_.residual_max = 0;
    const auto squares = [&](const std::vector<real>& v) { return sum_over_entries(count, [&](std::size_t i) { return v[i] * v[i]; }); };
    const auto largest_residual = [&] {
        constexpr std::size_t block = 8192;
        return ordered_max(static_cast<int>((count + block - 1) / block), [&](int part) {
            real most = 0;
            const std::size_t begin = at(part) * block, end = std::min(count, begin + block);
#pragma omp simd reduction(max : most)
            for (std::size_t i = begin; i < end; ++i) most = std::max(most, std::abs(r_[i]));
            return most;
        });
    };
    place(A, knots, b, b_);
    place(A, knots, x, x_);
    interpolate(A, x_);
    const auto residual = [&] {
        multiply_and_dot(A, x_, Ap_);
        return std::sqrt(sum_over_entries(count, [&](std::size_t i) {
            const real r = b_[i] - Ap_[i];
            r_[i] = r;
            return r * r;
        }));
    };
    const real scale = std::sqrt(squares(b_));
    if (!std::isfinite(scale)) throw NumericalFailure("pressure", "the right-hand side is not finite");
    real size = residual();
    if (!(size < scale)) {
        std::fill(x_.begin(), x_.end(), 0.0);
        std::copy(b_.begin(), b_.end(), r_.begin());
        size = scale;
    }
    report_.residual_before = scale > 0 ? size / scale : 0;
    const std::vector<float>& z = levels_[0].x;
    real rz = 0, alpha = 0;
    while (size > options_.tolerance * scale) {
        if (report_.iterations == options_.max_iterations) {
            if (options_.fixed_iterations) break;
            throw NumericalFailure("pressure", "the residual is still " + std::to_string(size / scale) + " of the right-hand side after " +
                                                   std::to_string(report_.iterations) + " iterations");
        }
        precondition(A, largest_residual());
        // Polak and Ribière's form, z·(r − r₋)/(z₋·r₋) with r − r₋ = −α A p: single precision leaves the preconditioner not quite the same.
        const bool first = report_.iterations == 0;
        const real beta =
            first ? 0 : -alpha * scale_ * sum_over_entries(count, [&](std::size_t i) { return static_cast<real>(z[i]) * Ap_[i]; }) / rz;
        rz = scale_ * sum_over_entries(count, [&](std::size_t i) {
                 const real direction = scale_ * static_cast<real>(z[i]);
                 p_[i] = first ? direction : direction + beta * p_[i];
                 return static_cast<real>(z[i]) * r_[i];
             });
        interpolate(A, p_);  // single precision has it nearly so
        alpha = rz / multiply_and_dot(A, p_, Ap_);
        if (!std::isfinite(alpha)) throw NumericalFailure("pressure", "conjugate gradients broke down");
        size = std::sqrt(sum_over_entries(count, [&](std::size_t i) {
            x_[i] += alpha * p_[i];
            const real r = r_[i] - alpha * Ap_[i];
            r_[i] = r;
            return r * r;
        }));
        ++report_.iterations;
        if (options_.record_history) report_.history.push_back(size / scale);
    }
    size = residual();
    report_.converged = size <= 2 * options_.tolerance * scale;
    report_.residual_after = scale > 0 ? size / scale : 0;
    report_.residual_max = largest_residual();
    fetch(A, knots, x_, x);
    return report_;
}

}  // namespace weir::tallcell
