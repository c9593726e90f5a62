// The levels of the multigrid on columns: coarser matrices, and the factors of every column's block.
#include "core/parallel.hpp"
#include "tallcell/column_rows.hpp"
#include "tallcell/multigrid.hpp"

#include <algorithm>
#include <limits>

namespace weir::tallcell {

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
    if (places_ == finest) return;  // entries between lines and rows are zero
    places_ = finest;
    for (auto* list : {&x_, &b_, &r_, &p_, &Ap_}) refill_lines(finest, *list);
}

/// Returns whether a level is distributed with this partition of its lines: it is large enough, and no parent has children on two ranks.
bool worth_sharing(const ColumnPlaces& places, const Partition& cut) {
    constexpr std::size_t small_level = 20000;  // as in poisson's multigrid
    const bool whole_pairs = std::all_of(cut.at.begin(), cut.at.end(), [&](int z) { return z % 2 == 0 || z == places.n[1]; });
    return whole_pairs && at(places.n[0]) * at(places.n[1]) * at(places.rows) >= small_level;
}

Partition halved(Partition cut) {
    for (int& z : cut.at) z = (z + 1) / 2;
    return cut;
}

/// Adds children (sx X + dx, sz Z + dz) to parent (X, Z). Faces between children of one parent vanish; other faces are halved.
void ColumnMultigrid::coarsen(const ColumnMatrix& A, ColumnMatrix& to) {
    to.n = {(A.n[0] + 1) / 2, (A.n[1] + 1) / 2};
    to.periodic = A.periodic;
    to.row = A.row;
    to.cut = halved(A.cut);
    to.rows = A.rows;
    const bool gathered = !to.cut.empty() && !worth_sharing(to, to.cut);
    to.resize(gathered);
    for_each_line_near(to, 0, [&](int Z) {
        add_children(A, to, Z);
        add_lower_faces(A, to, Z);
    });
    if (const int beyond = to.beyond(); beyond >= 0) add_lower_faces(A, to, beyond);
    if (gathered) {
        communicator().gather(to.cut, lines_of(to, to.state));
        for (auto* list : to.lists())
            if (list != &to.share) communicator().gather(to.cut, lines_of(to, *list));
        to.share.fill(0);
        to.cut = {};
    }
    to.finish();
}

/// All contributions to a parent except its faces towards the line below.
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

/// L D Lᵀ of adjacent columns, upwards: the data of the knot whose pivot is incomplete.
struct Elimination {
    Lanes<real> diagonal{}, whole{};  // its pivot, and the pivot before elimination
    Lanes<real> coupling{}, above{};  // with the next knot; contribution of the element between to that knot
    Lanes<std::size_t> place{};       // its index

    /// Inverse pivot and ratio to the next entry. A column without contact to air or other columns is singular: its last pivot is round-off
    /// and is set to zero.
    static std::array<real, 2> divide(real diagonal, real whole, real coupling) {
        const bool sound = diagonal > 64 * std::numeric_limits<real>::epsilon() * whole;
        const real inverse = sound ? 1 / (sound ? diagonal : 1) : 0;
        return {inverse, coupling * inverse};
    }
};

}  // namespace

/// W of a line, in single precision.
void ColumnMultigrid::narrow_beside(const ColumnMatrix& A, Level& level, int z) {
    for (const std::size_t h : {at(0), at(1)})
        for (std::size_t i = A.line(z); i < A.line(z + 1); ++i) {
            level.beside[h][i] = static_cast<float>(A.beside[h][i]);
            level.beside_next[h][i] = static_cast<float>(A.beside_next[h][i]);
        }
}

/// One function, because the coefficients of a row stay in vector registers from their sum to the elimination: L D Lᵀ of every column, from
/// the bottom upwards.
void ColumnMultigrid::factorise(const ColumnMatrix& A, Level& level) {
    const bool moved = !(level.places == A);
    if (moved)
        for (auto* list : {&level.diagonal, &level.next, &level.inverse, &level.ratio, &level.x, &level.b, &level.r})
            refill_lines(A, *list);
    level.places = A;
    for (const std::size_t h : {at(0), at(1)}) {
        resize_lines(A, level.beside[h]);
        resize_lines(A, level.beside_next[h]);
    }
    const std::ptrdiff_t row = A.row_stride();
    for_each_line_near(A, 0, [&](int z) { narrow_beside(A, level, z); });
    if (const int beyond = A.beyond(); beyond >= 0) narrow_beside(A, level, beyond);
    if (moved) narrow_beside(A, level, ColumnPlaces::no_line);
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
                    if (k == 0 || k < A.mixed_end) {  // knots are in different rows: one column after the other
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

}  // namespace weir::tallcell
