// Conjugate gradients preconditioned by the multigrid cycle, in double precision on shared rows.
#include "linear/conjugate_gradients.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "tallcell/column_rows.hpp"
#include "tallcell/multigrid.hpp"

#include <algorithm>
#include <cmath>

namespace weir::tallcell {

namespace {

/// f(block, begin, end) for the entries of this rank's lines, in blocks of equal size.
template <class F>
void for_each_block_of_lines(const ColumnPlaces& places, F&& f) {
    const std::size_t line = at(places.line_stride());
    const int blocks = places.blocks_of_line();
    parallel_for(places.own().begin * blocks, places.own().end * blocks, [&](int i) {
        const std::size_t first = places.line(i / blocks), begin = first + at(i % blocks * ColumnPlaces::block);
        f(i, begin, std::min(first + line, begin + at(ColumnPlaces::block)));
    });
}

/// N sums and M maxima.
template <std::size_t N, std::size_t M>
struct Totals {
    std::array<real, N> sums{};
    std::array<real, M> largest{};
    void see(const std::array<real, M>& other) {
        for (std::size_t i = 0; i < M; ++i) largest[i] = std::max(largest[i], other[i]);
    }
};

/// The totals of f(begin, end) over all blocks of all ranks; sums are exact.
template <std::size_t N, std::size_t M, class F>
Totals<N, M> totals_of_lines(const ColumnPlaces& places, F&& f) {
    const int blocks = places.blocks_of_line(), first = places.own().begin * blocks;
    const auto count = at(places.own().end * blocks - first);
    auto& parts = detail::reduction_scratch(count * (N + M));  // N sums and M maxima of each block
    for_each_block_of_lines(places, [&](int i, std::size_t begin, std::size_t end) {
        const Totals<N, M> part = f(begin, end);
        const auto to = parts.begin() + static_cast<std::ptrdiff_t>(at(i - first) * (N + M));
        std::copy(part.largest.begin(), part.largest.end(), std::copy(part.sums.begin(), part.sums.end(), to));
    });
    struct OfRank {
        ExactSums<std::array<real, N>> sums{};
        Totals<N, M> most{};
        void add(const OfRank& other) { sums.add(other.sums), most.see(other.most.largest); }
    } all;
    for (std::size_t i = 0; i < count; ++i) {
        Totals<N, M> part;
        std::copy_n(&parts[i * (N + M)], N, part.sums.begin());
        std::copy_n(parts.data() + i * (N + M) + N, M, part.largest.begin());
        all.sums.add(part.sums), all.most.see(part.largest);
    }
    all = sum_of_ranks(places.planes(), all);
    return {all.sums.value(), all.most.largest};
}

/// y = A x; returns x·y. In parallel the ghost lines of x must be filled.
real multiply_and_dot(const ColumnMatrix& A, LineStore<real>& x, LineStore<real>& y) {
    const std::ptrdiff_t row = A.row_stride();
    auto& parts = detail::reduction_scratch(at(A.n[1]));
    for_each_line_near(A, 0, [&](int z) {
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
        parts[at(z)] = dot;
    });
    const LineRange own = A.own();
    ExactSum sum;
    sum.add(std::span<const real>(parts).subspan(at(own.begin), at(own.end - own.begin)));
    return sum_of_ranks(A.planes(), sum).value();
}

}  // namespace

/// Copies values by knots to the shared rows; rows inside elements are zero.
void ColumnMultigrid::place(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& from, LineStore<real>& to) const {
    const std::size_t stride = at(A.row_stride());
    for_each_line_near(A, 0, [&](int z) {
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

/// Copies back; in parallel also from ghost lines.
void ColumnMultigrid::fetch(const ColumnMatrix& A, const Knots& knots, const LineStore<real>& from, std::vector<real>& to) const {
    const std::size_t stride = at(A.row_stride());
    for_each_line_near(A, 1, [&](int z) {
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
    refresh_lines(A, x_);
    multiply_and_dot(A, x_, Ap_);
    fetch(A, knots, Ap_, y);
}

void ColumnMultigrid::precondition(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& r, std::vector<real>& z) {
    real largest = 0;
    for (const real value : r) largest = std::max(largest, std::abs(value));
    place(A, knots, r, r_);
    precondition(A, largest);
    std::copy_n(levels_[0].x.data(), levels_[0].x.size(), p_.data());
    fetch(A, knots, p_, z);
    for (real& value : z) value *= scale_;
}

struct ColumnMultigrid::System {
    static constexpr linear::Norm norm = linear::Norm::residual;
    ColumnMultigrid& of;
    const ColumnMatrix& A;
    real largest, b_norm;  // of r; ‖b‖
    real zAp = 0;          // before scaling

    /// The inner products with r and with the last A p in one pass.
    real precondition() {
        of.precondition(A, largest);
        const LineStore<float>& z = of.levels_[0].x;
        const auto totals = totals_of_lines<2, 0>(A, [&](std::size_t begin, std::size_t end) {
            real with_Ap = 0, zr = 0;
#pragma omp simd reduction(+ : with_Ap, zr)
            for (std::size_t i = begin; i < end; ++i) {
                with_Ap += static_cast<real>(z[i]) * of.Ap_[i];
                zr += static_cast<real>(z[i]) * of.r_[i];
            }
            return Totals<2, 0>{{with_Ap, zr}, {}};
        });
        zAp = totals.sums[0];
        return of.scale_ * totals.sums[1];
    }
    /// A single-precision preconditioner is not exactly constant.
    real flexible_beta(const linear::Step& last) const { return -last.alpha * of.scale_ * zAp / last.rz; }
    void update_direction(real beta) {
        const LineStore<float>& z = of.levels_[0].x;
        for_each_block_of_lines(A, [&](int, std::size_t begin, std::size_t end) {
            if (beta == 0)
                for (std::size_t i = begin; i < end; ++i) of.p_[i] = of.scale_ * static_cast<real>(z[i]);
            else
                for (std::size_t i = begin; i < end; ++i) of.p_[i] = of.scale_ * static_cast<real>(z[i]) + beta * of.p_[i];
        });
        interpolate(A, of.p_);  // exact interpolation: single precision has it only nearly
        refresh_lines(A, of.p_);
    }
    real multiply() { return multiply_and_dot(A, of.p_, of.Ap_); }
    real advance(real alpha) {
        const auto totals = totals_of_lines<1, 1>(A, [&](std::size_t begin, std::size_t end) {
            real squares = 0, most = 0;
#pragma omp simd reduction(+ : squares) reduction(max : most)
            for (std::size_t i = begin; i < end; ++i) {
                of.x_[i] += alpha * of.p_[i];
                const real r = of.r_[i] - alpha * of.Ap_[i];
                of.r_[i] = r;
                squares += r * r;
                most = std::max(most, std::abs(r));
            }
            return Totals<1, 1>{{squares}, {most}};
        });
        largest = totals.largest[0];
        return std::sqrt(totals.sums[0]) / b_norm;
    }
};

const poisson::Report& ColumnMultigrid::solve(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& b, std::vector<real>& x) {
    report_.history.clear();
    report_.iterations = 0;
    place(A, knots, b, b_);
    place(A, knots, x, x_);
    interpolate(A, x_);
    Residual r = residual(A);
    const real scale = std::sqrt(r.b_squares);
    if (!std::isfinite(scale)) throw NumericalFailure("pressure", "the right-hand side is not finite");
    real size = r.norm;
    if (!(size < scale)) {
        for_each_block_of_lines(A, [&](int, std::size_t begin, std::size_t end) {
            std::fill_n(x_.data() + begin, end - begin, 0.0);
            std::copy_n(b_.data() + begin, end - begin, r_.data() + begin);
        });
        size = scale, r.largest = r.b_largest;
    }
    report_.residual_before = scale > 0 ? size / scale : 0;
    System system{*this, A, r.largest, scale};
    linear::StopTest stop(options_.tolerance, options_.max_iterations, report_.iterations,
                          options_.record_history ? &report_.history : nullptr);
    const linear::Outcome outcome = linear::conjugate_gradients(system, stop, report_.residual_before);
    const bool accepted = options_.fixed_iterations && std::isfinite(outcome.relative_residual);
    if (!accepted) linear::require_converged("pressure", "pressure solve", outcome, stop);
    r = residual(A);
    report_.converged = r.norm <= 2 * options_.tolerance * scale;
    report_.residual_after = scale > 0 ? r.norm / scale : 0;
    report_.residual_max = r.largest;
    fetch(A, knots, x_, x);
    return report_;
}

/// r = b − A x.
ColumnMultigrid::Residual ColumnMultigrid::residual(const ColumnMatrix& A) {
    refresh_lines(A, x_);
    multiply_and_dot(A, x_, Ap_);
    const auto totals = totals_of_lines<2, 2>(A, [&](std::size_t begin, std::size_t end) {
        real squares = 0, most = 0, b_squares = 0, b_most = 0;
#pragma omp simd reduction(+ : squares, b_squares) reduction(max : most, b_most)
        for (std::size_t i = begin; i < end; ++i) {
            const real r = b_[i] - Ap_[i];
            r_[i] = r;
            squares += r * r, b_squares += b_[i] * b_[i];
            most = std::max(most, std::abs(r)), b_most = std::max(b_most, std::abs(b_[i]));
        }
        return Totals<2, 2>{{squares, b_squares}, {most, b_most}};
    });
    return {std::sqrt(totals.sums[0]), totals.largest[0], totals.sums[1], totals.largest[1]};
}

}  // namespace weir::tallcell
