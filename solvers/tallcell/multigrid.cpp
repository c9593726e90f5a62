#include "tallcell/multigrid.hpp"

#include "core/parallel.hpp"
#include "tallcell/column_rows.hpp"

#include <algorithm>

namespace weir::tallcell {

std::size_t ColumnMultigrid::bytes() const {
    std::size_t total = x_.bytes() + b_.bytes() + r_.bytes() + p_.bytes() + Ap_.bytes();
    for (const Level& level : levels_) {
        total += level.coarse.bytes();
        for (const auto* list : {&level.beside[0], &level.beside[1], &level.beside_next[0], &level.beside_next[1], &level.diagonal,
                                 &level.next, &level.inverse, &level.ratio, &level.x, &level.b, &level.r})
            total += list->bytes();
    }
    return total;
}

/// Solves for x of adjacent columns from b and their neighbours: L D Lᵀ, upwards and down again. `alone`: the neighbours are zero. Only
/// columns of the other colour, and the line's ends, are read; their x is interpolated inside elements. One function: the four sweeps over
/// a column are one substitution and pass on the values of the row before in vector registers.
void ColumnMultigrid::solve_columns(const ColumnMatrix& A, Level& level, int z, int parity, int begin, int end, bool alone) {
    const int count = end - begin, mixed_end = A.mixed_end;
    const Beside to(A, z, parity);
    const auto right_hand_side = [&](int k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        const float* b = level.b.data() + first;
        float* x = level.x.data() + first;
        Lanes<float> sum;
        for (int i = 0; i < count; ++i) sum[at(i)] = b[i];
        if (!alone) add_row(A, level.beside, level.beside_next, level.x.data(), k, first, to, count, sum.data());
        for (int i = 0; i < count; ++i) x[i] = sum[at(i)];
    };
    Lanes<float> carried{};
    for (int k = mixed_end - 1; k >= 0; --k) {
        right_hand_side(k);
        const std::size_t first = A.first(z, k, parity) + at(begin);
        gather_down(A.share.data() + first, level.x.data() + first, carried.data(), count);
    }
    carried.fill(0);
    Lanes<float> below{};
    for (int k = 0; k < A.rows; ++k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        const float* ratio = level.ratio.data() + first;
        float* x = level.x.data() + first;
        if (k < mixed_end) {
            const real* share = A.share.data() + first;
            gather_up(share, x, carried.data(), count);
            for (int i = 0; i < count; ++i) {
                const bool knot = share[i] == 0;
                const float y = x[i] - below[at(i)];
                x[i] = knot ? y : 0;
                below[at(i)] = knot ? ratio[i] * y : below[at(i)];
            }
            continue;
        }
        right_hand_side(k);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const float y = x[i] - below[at(i)];
            x[i] = y;
            below[at(i)] = ratio[i] * y;
        }
    }
    Lanes<float> above{};
    for (int k = A.rows - 1; k >= 0; --k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        const float *ratio = level.ratio.data() + first, *inverse = level.inverse.data() + first;
        float* x = level.x.data() + first;
        if (k < mixed_end) {
            const real* share = A.share.data() + first;
            for (int i = 0; i < count; ++i) {
                const float solved = x[i] * inverse[i] - ratio[i] * above[at(i)];
                above[at(i)] = share[i] == 0 ? solved : above[at(i)];
                x[i] = above[at(i)];
            }
            continue;
        }
#pragma omp simd
        for (int i = 0; i < count; ++i) x[i] = above[at(i)] = x[i] * inverse[i] - ratio[i] * above[at(i)];
    }
    for (int k = 0; k < mixed_end; ++k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        const real* share = A.share.data() + first;
        float* x = level.x.data() + first;
        for (int i = 0; i < count; ++i) {
            above[at(i)] = share[i] == 0 ? x[i] : above[at(i)];
            x[i] = above[at(i)] + static_cast<float>(share[i]) * (x[i] - above[at(i)]);
        }
    }
}

/// Returns whether, after sweeps that end with the second colour, only the first colour may have a residual; only it then needs a
/// correction before sweeps that start with it.
static bool one_colour(const ColumnMatrix& A) { return !A.joint(0) && !A.joint(1); }

/// Sweeps over all columns, one checkerboard colour after the other. Around a periodic axis with an odd number of columns the last line is
/// a colour of its own; along a line the neighbour beyond the end has its old value. In parallel the ghost lines are filled after each
/// colour, the last one only if `read`.
void ColumnMultigrid::sweep(const ColumnMatrix& A, Level& level, bool upwards, bool from_zero, bool read) {
    const int last = A.n[1] - 1, lines = A.joint(1) && last > 0 ? last : A.n[1], phases = lines < A.n[1] ? 4 : 2;
    const LineRange own = A.own();
    if (from_zero && !one_colour(A))
        for_each_line_near(A, 1, [&](int z) { std::fill_n(level.x.data() + A.line(z), A.line_stride(), 0.0f); });
    for (int i = 0; i < phases; ++i) {
        const int phase = upwards ? i : phases - 1 - i, colour = phase % 2;
        const bool alone = from_zero && i == 0;
        const int z_begin = std::max(own.begin, phase < 2 ? 0 : last), z_end = std::min(own.end, phase < 2 ? lines : A.n[1]);
        if (A.periodic[0] && A.n[0] > 1 && !alone) parallel_for(z_begin, z_end, [&](int z) { wrap_line(A, z, level.x.data()); });
        const auto parity = [&](int z) { return (colour + z) % 2; };
        for_each_block(A, z_begin, z_end, parity,
                       [&](int z, int begin, int end) { solve_columns(A, level, z, parity(z), begin, end, alone); });
        if (read || i + 1 < phases) refresh_lines(A, level.x);
    }
}

/// r = b − A x on shared rows.
void ColumnMultigrid::residual(const ColumnMatrix& A, Level& level) {
    const std::ptrdiff_t row = A.row_stride();
    if (A.periodic[0] && A.n[0] > 1) for_each_line_near(A, 0, [&](int z) { wrap_line(A, z, level.x.data()); });
    for (int colour = 0; colour < (one_colour(A) ? 1 : 2); ++colour) {
        const auto parity = [&](int z) { return (colour + z) % 2; };
        for_each_block(A, A.own().begin, A.own().end, parity, [&](int z, int begin, int end) {
            const Beside to(A, z, parity(z));
            const int count = end - begin;
            for (int k = 0; k < A.rows; ++k) {
                const std::size_t first = A.first(z, k, parity(z)) + at(begin);
                const float *x = level.x.data() + first, *b = level.b.data() + first;
                const float *diagonal = level.diagonal.data() + first, *next = level.next.data() + first;
                float* r = level.r.data() + first;
#pragma omp simd
                for (int i = 0; i < count; ++i) r[i] = b[i] - diagonal[i] * x[i] - (next[i] * x[i + row] + next[i - row] * x[i - row]);
                add_row(A, level.beside, level.beside_next, level.x.data(), k, first, to, count, r);
            }
        });
    }
}

/// b of the parents: Pᵀ r. In parallel all ranks get the first level that is not distributed.
void ColumnMultigrid::restrict_residual(const ColumnMatrix& A, const Level& level, const ColumnMatrix& coarse, Level& next) {
    const int sx = A.n[0] > 1 ? 2 : 1, sz = A.n[1] > 1 ? 2 : 1;
    const bool all = !one_colour(A);
    ColumnPlaces parents = coarse;
    parents.cut = halved(A.cut);
    for_each_line_near(parents, 0, [&](int Z) {
        for (int k = 0; k < A.rows; ++k)
            for (const int parity : {0, 1}) {
                float* b = next.b.data() + coarse.first(Z, k, parity);
                std::fill(b, b + coarse.of_parity(parity), 0.0f);
                for (int dz = 0; dz < sz && sz * Z + dz < A.n[1]; ++dz)
                    for (int dx = 0; dx < sx; ++dx) {
                        if (!all && (dx + dz) % 2 != 0) continue;
                        const float* r = level.r.data() + A.first(sz * Z + dz, k, dx);
                        const int children = A.of_parity(dx);
                        for (int i = 0; i < coarse.of_parity(parity) && 2 * i + parity < children; ++i) b[i] += r[2 * i + parity];
                    }
            }
        for (const int parity : {0, 1})
            for (int begin = 0; begin < coarse.of_parity(parity); begin += lanes)
                gather(coarse, Z, parity, begin, std::min(begin + lanes, coarse.of_parity(parity)), next.b.data());
    });
    if (!A.cut.empty() && coarse.cut.empty()) communicator().gather(parents.cut, lines_of(coarse, next.b));
}

/// x += P x of the parents; in parallel also on ghost lines, where x of children and parents is known.
void ColumnMultigrid::add_correction(const ColumnMatrix& A, Level& level, const ColumnMatrix& coarse, const Level& next) {
    const int sx = A.n[0] > 1 ? 2 : 1, sz = A.n[1] > 1 ? 2 : 1;
    const bool all = !one_colour(A);
    for_each_line_near(A, 1, [&](int z) {
        for (int k = 0; k < A.rows; ++k)
            for (int dx = 0; dx < sx; ++dx) {
                if (!all && (dx + z) % 2 != 0) continue;
                float* x = level.x.data() + A.first(z, k, dx);
                const int children = A.of_parity(dx);
                for (const int parity : {0, 1}) {
                    const float* X = next.x.data() + coarse.first(z / sz, k, parity);
                    for (int i = 0; 2 * i + parity < children; ++i) x[2 * i + parity] += X[i];
                }
            }
    });
}

void ColumnMultigrid::cycle(std::size_t l, const ColumnMatrix& A) {
    Level& level = levels_[l];
    if (l + 1 == levels_.size()) {
        solve_columns(A, level, 0, 0, 0, 1, true);
        return;
    }
    for (int s = 0; s < sweeps_; ++s) sweep(A, level, true, s == 0, true);
    residual(A, level);
    restrict_residual(A, level, levels_[l + 1].coarse, levels_[l + 1]);
    cycle(l + 1, levels_[l + 1].coarse);
    add_correction(A, level, levels_[l + 1].coarse, levels_[l + 1]);
    for (int s = 0; s < sweeps_; ++s) sweep(A, level, false, false, l > 0 || s + 1 < sweeps_);
}

/// x of the finest level times scale_ = M⁻¹ r_.
void ColumnMultigrid::precondition(const ColumnMatrix& A, real largest) {
    Level& level = levels_[0];
    scale_ = largest > 0 ? largest : 1;  // single precision has a limited range
    for_each_line_near(A, 0, [&](int z) {
        for (std::size_t i = A.line(z); i < A.line(z + 1); ++i) level.b[i] = static_cast<float>(r_[i] / scale_);
    });
    cycle(0, A);
}

}  // namespace weir::tallcell
