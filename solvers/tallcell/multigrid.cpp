#include "tallcell/multigrid.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "tallcell/column_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weir::tallcell {

std::size_t ColumnMultigrid::bytes() const {
    std::size_t total = (x_.capacity() + b_.capacity() + r_.capacity() + p_.capacity() + Ap_.capacity()) * sizeof(real);
    for (const Level& level : levels_) {
        total += level.coarse.bytes();
        for (const auto* list : {&level.beside[0], &level.beside[1], &level.beside_next[0], &level.beside_next[1], &level.diagonal,
                                 &level.next, &level.inverse, &level.ratio, &level.x, &level.b, &level.r})
            total += list->capacity() * sizeof(float);
    }
    return total;
}

void ColumnMultigrid::setup(const ColumnMatrix& finest) {
    const ColumnMatrix* A = &finest;
    for (std::size_t l = 0;; ++l) {
        if (l == levels_.size()) levels_.emplace_back();
        A = l == 0 ? &finest : &levels_[l].coarse;
        factorise(*A, levels_[l]);
        if (A->n[0] == 1 && A->n[1] == 1) break;
        if (l + 1 == levels_.size()) levels_.emplace_back();
        A = l == 0 ? &finest : &levels_[l].coarse;
        coarsen(*A, levels_[l + 1].coarse);
    }
    if (places_ == finest) return;  // what lies between lines and rows is zero
    places_ = finest;
    for (auto* list : {&x_, &b_, &r_, &p_, &Ap_}) refill_scratch(*list, finest.size(), 0.0);
}

/// A level whose lines are cut so is worth messages: it has enough entries, and none of its parents has children of two ranks.
bool worth_sharing(const ColumnPlaces& places, const Cut& cut) {
    constexpr std::size_t small_level = 20000;  // as of poisson's multigrid
    const bool whole_pairs = std::all_of(cut.at.begin(), cut.at.end(), [&](int z) { return z % 2 == 0 || z == places.n[1]; });
    return whole_pairs && at(places.n[0]) * at(places.n[1]) * at(places.rows) >= small_level;
}

Cut halved(Cut cut) {
    for (int& z : cut.at) z = (z + 1) / 2;
    return cut;
}

/// Children (sx X + dx, sz Z + dz) of parent (X, Z). Faces between children of one parent vanish; of the others half counts.
void ColumnMultigrid::coarsen(const ColumnMatrix& A, ColumnMatrix& to) {
    to.n = {(A.n[0] + 1) / 2, (A.n[1] + 1) / 2};
    to.periodic = A.periodic;
    to.row = A.row;
    to.cut = halved(A.cut);
    to.resize();
    for_each_line_near(to, 0, [&](int Z) { add_children(A, to, Z); });
    for_each_line_near(to, 1, [&](int Z) { add_lower_faces(A, to, Z); });  // those of the line beyond are this one's too
    if (!to.cut.empty() && !worth_sharing(to, to.cut)) {
        const auto plane = at(to.line_stride());
        slabs().gather(to.cut, {to.state.data(), plane * sizeof(to.state[0]), to.n[1]});
        for (auto* list : to.lists())
            if (list != &to.share) slabs().gather(to.cut, {list->data(), plane * sizeof(real), to.n[1]});
        std::fill(to.share.begin(), to.share.end(), 0.0);
        to.cut = {};
    }
    to.finish();
}

/// Of all of a parent but its faces towards the line below.
void ColumnMultigrid::add_children(const ColumnMatrix& A, ColumnMatrix& to, int Z) {
    const int sx = A.n[0] > 1 ? 2 : 1, sz = A.n[1] > 1 ? 2 : 1;
    for (int k = 0; k < A.rows; ++k)
        for (int dz = 0; dz < sz && sz * Z + dz < A.n[1]; ++dz)
            for (int dx = 0; dx < sx; ++dx)
                for (int X = 0; X < to.n[0] && sx * X + dx < A.n[0]; ++X) {
                    const std::size_t child = A.at(sx * X + dx, sz * Z + dz, k), parent = to.at(X, Z, k);
                    to.state[parent] |= A.state[child];
                    to.vertical[parent] += A.vertical[child];
                    to.lid[parent] += A.lid[child];
                    to.sink[parent] += 0.5 * A.sink[child];
                    to.sink_next[parent] += 0.5 * A.sink_next[child];
                    if (dx == 0 && to.n[0] > 1) {
                        to.beside[0][parent] += 0.5 * A.beside[0][child];
                        to.beside_next[0][parent] += 0.5 * A.beside_next[0][child];
                    }
                }
}

void ColumnMultigrid::add_lower_faces(const ColumnMatrix& A, ColumnMatrix& to, int Z) {
    const int sx = A.n[0] > 1 ? 2 : 1, sz = A.n[1] > 1 ? 2 : 1;
    if (to.n[1] == 1) return;
    for (int k = 0; k < A.rows; ++k)
        for (int dx = 0; dx < sx; ++dx)
            for (int X = 0; X < to.n[0] && sx * X + dx < A.n[0]; ++X) {
                const std::size_t child = A.at(sx * X + dx, sz * Z, k), parent = to.at(X, Z, k);
                to.beside[1][parent] += 0.5 * A.beside[1][child];
                to.beside_next[1][parent] += 0.5 * A.beside_next[1][child];
            }
}

namespace {

/// L D Lᵀ of columns side by side, upwards: what is known of the knot whose pivot is not yet complete.
struct Elimination {
    Lanes<real> diagonal{}, whole{};  // of it, and without what has been taken from it
    Lanes<real> coupling{}, above{};  // with the next knot, and what the element between gives to that
    Lanes<std::size_t> place{};       // of it

    /// The pivot's inverse and the ratio to the next entry. A column that touches neither air nor another is singular: its last pivot is
    /// round-off, and counts as none.
    static std::array<real, 2> divide(real diagonal, real whole, real coupling) {
        const bool sound = diagonal > 64 * std::numeric_limits<real>::epsilon() * whole;
        const real inverse = sound ? 1 / (sound ? diagonal : 1) : 0;
        return {inverse, coupling * inverse};
    }
};

}  // namespace

/// W of a line, in single precision.
void ColumnMultigrid::narrow_beside(const ColumnMatrix& A, Level& level, int z) {
    const std::size_t from = at(z * A.line_stride()), to = from + at(A.line_stride());
    for (const std::size_t h : {at(0), at(1)})
        for (std::size_t i = from; i < to; ++i) {
            level.beside[h][i] = static_cast<float>(A.beside[h][i]);
            level.beside_next[h][i] = static_cast<float>(A.beside_next[h][i]);
        }
}

void ColumnMultigrid::factorise(const ColumnMatrix& A, Level& level) {
    const std::size_t size = A.size();
    const bool moved = !(level.places == A);
    if (moved)
        for (auto* list : {&level.diagonal, &level.next, &level.inverse, &level.ratio, &level.x, &level.b, &level.r})
            refill_scratch(*list, size, 0.0f);
    level.places = A;
    for (const std::size_t h : {at(0), at(1)}) {
        resize_scratch(level.beside[h], size);
        resize_scratch(level.beside_next[h], size);
    }
    const std::ptrdiff_t row = A.row_stride();
    for_each_line_near(A, 1, [&](int z) { narrow_beside(A, level, z); });
    if (moved) narrow_beside(A, level, A.n[1]);
    for_each_line_near(A, 0, [&](int z) {
        for (const int parity : {0, 1})
            for (int begin = 0; begin < A.of_parity(parity); begin += lanes) {
                const int count = std::min(lanes, A.of_parity(parity) - begin);
                const Beside to_side(A, z, parity);
                Elimination e;
                Lanes<real> D{}, O{}, O_below{};
                for (int k = 0; k < A.rows; ++k) {
                    const std::size_t first = A.first(z, k, parity) + at(begin);
                    const real *c = A.vertical.data() + first, *lid = A.lid.data() + first, *sink = A.sink.data() + first;
                    const real *w0 = A.beside[0].data() + first, *w1 = A.beside[1].data() + first;
                    const real *n0 = A.beside_next[0].data() + first, *n1 = A.beside_next[1].data() + first;
                    const real* sink_next = A.sink_next.data() + first;
                    float *diagonal = level.diagonal.data() + first, *next = level.next.data() + first;
#pragma omp simd
                    for (int i = 0; i < count; ++i) {
                        O_below[at(i)] = O[at(i)];
                        D[at(i)] = (c[i] + c[i - row]) + (lid[i] + sink[i]) +
                                   ((w0[i] + w0[i + to_side.x_upper]) + (w1[i] + w1[i + to_side.z_upper]));
                        O[at(i)] = sink_next[i] - c[i] + ((n0[i] + n0[i + to_side.x_upper]) + (n1[i] + n1[i + to_side.z_upper]));
                        diagonal[i] = static_cast<float>(D[at(i)]);
                        next[i] = static_cast<float>(O[at(i)]);
                    }
                    if (k == 0 || k < A.mixed_end) {  // knots stand in different rows: one column after the other
                        const real *share = A.share.data() + first, *share_below = share - row;
                        for (int i = 0; i < count; ++i) {
                            const std::size_t l = at(i);
                            const bool knot = share[i] == 0;
                            const real s = knot ? 1 : share[i], t = k > 0 ? share_below[i] : 0;
                            const real to_lower = (1 - s) * (1 - t) * 2 * O_below[l] + (knot ? 0 : (1 - s) * (1 - s) * D[l]);
                            e.diagonal[l] += to_lower, e.whole[l] += to_lower;
                            e.coupling[l] += O_below[l] * ((1 - t) * s + t * (1 - s)) + (knot ? 0 : s * (1 - s) * D[l]);
                            e.above[l] += 2 * O_below[l] * t * s + (knot ? 0 : s * s * D[l]);
                            if (!knot) continue;
                            const auto [inverse, ratio] = Elimination::divide(e.diagonal[l], e.whole[l], e.coupling[l]);
                            if (k > 0) {
                                level.inverse[e.place[l]] = static_cast<float>(inverse);
                                level.ratio[e.place[l]] = static_cast<float>(ratio);
                            }
                            e.whole[l] = D[l] + e.above[l];
                            e.diagonal[l] = e.whole[l] - (k > 0 ? e.coupling[l] * ratio : 0);
                            e.coupling[l] = e.above[l] = 0;
                            e.place[l] = first + l;
                        }
                        continue;
                    }
                    float *inverse_below = level.inverse.data() + first - row, *ratio_below = level.ratio.data() + first - row;
#pragma omp simd
                    for (int i = 0; i < count; ++i) {
                        const auto [inverse, ratio] = Elimination::divide(e.diagonal[at(i)], e.whole[at(i)], O_below[at(i)]);
                        inverse_below[i] = static_cast<float>(inverse);
                        ratio_below[i] = static_cast<float>(ratio);
                        e.whole[at(i)] = D[at(i)];
                        e.diagonal[at(i)] = D[at(i)] - O_below[at(i)] * ratio;
                    }
                }
                const std::size_t top = A.first(z, A.rows - 1, parity) + at(begin);
                for (int i = 0; i < count; ++i)
                    level.inverse[top + at(i)] = static_cast<float>(Elimination::divide(e.diagonal[at(i)], e.whole[at(i)], 0)[0]);
            }
    });
}

/// x of columns side by side from b and from the columns beside them: L D Lᵀ, upwards and down again. `alone`: those beside are zero. Only
/// columns of the other colour, and the line's ends, are read; x of these holds what is between.
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

/// Whether columns of the first colour alone may have a residual after sweeps that end with the second, and need a correction before
/// sweeps that begin with it.
static bool one_colour(const ColumnMatrix& A) { return !A.joint(0) && !A.joint(1); }

/// All columns, one colour of the checkerboard after the other. Around a periodic axis with an odd number of columns the last line comes by
/// itself; along a line the neighbour beyond the end is what it was before. Over ranks each colour is brought from beyond the cuts, the
/// last one where it is `read`.
void ColumnMultigrid::sweep(const ColumnMatrix& A, Level& level, bool upwards, bool from_zero, bool read) {
    const int last = A.n[1] - 1, lines = A.joint(1) && last > 0 ? last : A.n[1], phases = lines < A.n[1] ? 4 : 2;
    const LineRange own = A.own();
    if (from_zero && !one_colour(A))
        for_each_line_near(A, 1, [&](int z) { std::fill_n(level.x.data() + z * A.line_stride(), A.line_stride(), 0.0f); });
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

/// b of the parents: Pᵀ r. Over ranks everybody gets all of the first level that is not shared.
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
    if (!A.cut.empty() && coarse.cut.empty())
        slabs().gather(parents.cut, {next.b.data(), sizeof(float) * at(coarse.line_stride()), coarse.n[1]});
}

/// x += P x of the parents; over ranks beyond the cuts too, where x is known of children and parents.
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
    scale_ = largest > 0 ? largest : 1;  // single precision has no room for what is very small
    for_each_line_near(A, 0, [&](int z) {
        const std::size_t from = at(z * A.line_stride()), to = from + at(A.line_stride());
        for (std::size_t i = from; i < to; ++i) level.b[i] = static_cast<float>(r_[i] / scale_);
    });
    cycle(0, A);
}

}  // namespace weir::tallcell
