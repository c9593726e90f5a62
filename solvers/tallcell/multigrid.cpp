#include "tallcell/multigrid.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/scratch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weir::tallcell {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Sum over all knots of f(i), column by column in order: no result depends on the number of threads.
template <class F>
real sum_over_knots(const Knots& knots, F&& f) {
    constexpr int block = 64;
    const int columns = knots.columns();
    return ordered_sum((columns + block - 1) / block, [&](int b) {
        real sum = 0;
        for (int i = knots.start[at(b * block)]; i < knots.start[at(std::min(columns, (b + 1) * block))]; ++i) sum += f(at(i));
        return sum;
    });
}

real dot(const Knots& knots, const std::vector<real>& a, const std::vector<real>& b) {
    return sum_over_knots(knots, [&](std::size_t i) { return a[i] * b[i]; });
}

/// f(i) for all knots, threaded over columns.
template <class F>
void for_each_knot(const Knots& knots, F&& f) {
    parallel_for(0, knots.columns(), [&](int c) {
        for (int i = knots.start[at(c)]; i < knots.start[at(c) + 1]; ++i) f(at(i));
    });
}

/// f(child) for the columns that become one, in order.
template <class F>
void for_each_child(const ColumnMatrix& A, const ColumnMatrix& to, int parent, F&& f) {
    const int px = parent % to.n[0], pz = parent / to.n[0];
    const int sx = A.n[0] > 1 ? 2 : 1, sz = A.n[1] > 1 ? 2 : 1;
    for (int z = sz * pz; z < std::min(sz * pz + sz, A.n[1]); ++z)
        for (int x = sx * px; x < std::min(sx * px + sx, A.n[0]); ++x) f(x + z * A.n[0]);
}

int parent_of(const ColumnMatrix& A, const ColumnMatrix& to, int child) {
    const int x = child % A.n[0], z = child / A.n[0];
    return (A.n[0] > 1 ? x / 2 : x) + (A.n[1] > 1 ? z / 2 : z) * to.n[0];
}

}  // namespace

int ColumnMatrix::neighbour(int column, int f) const {
    const auto h = at(f / 2);
    const int m = n[h], stride = h == 0 ? 1 : n[0], i = h == 0 ? column % n[0] : column / n[0], by = f % 2 == 0 ? -1 : 1;
    if (m == 1) return -1;
    if (i + by >= 0 && i + by < m) return column + by * stride;
    return periodic[h] ? column - by * (m - 1) * stride : -1;
}

void ColumnMatrix::resize() {
    const auto count = at(knots.count());
    for (auto* list : {&vertical, &vertical_next, &horizontal, &horizontal_next}) refill_scratch(*list, count, 0.0);
    refill_scratch(begin, count * at(faces()) + 1, 0);
}

void ColumnMatrix::place_entries(const std::vector<int>& from) {
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    resize_scratch(beside, at(begin.back()));
    refill_scratch(entry, beside.size(), 0.0);
    for_each_knot(knots, [&](std::size_t i) {
        for (std::size_t row = i * at(faces()); row < (i + 1) * at(faces()); ++row)
            for (int e = begin[row]; e < begin[row + 1]; ++e) beside[at(e)] = from[row] + e - begin[row];
    });
}

std::size_t ColumnMatrix::bytes() const {
    return knots.bytes() + (begin.capacity() + beside.capacity() + lowest.capacity() + highest.capacity()) * sizeof(int) +
           (vertical.capacity() + vertical_next.capacity() + horizontal.capacity() + horizontal_next.capacity() + entry.capacity()) *
               sizeof(real);
}

std::size_t ColumnMultigrid::bytes() const {
    std::size_t total = (r_.capacity() + p_.capacity() + Ap_.capacity() + z_.capacity()) * sizeof(real);
    for (const Level& level : levels_) {
        total += level.coarse.bytes() + level.parent.capacity() * sizeof(int);
        total += level.share.capacity() * sizeof(real) + level.first.capacity() * sizeof(int);
        for (const auto* list : {&level.entry, &level.diagonal, &level.next, &level.inverse, &level.ratio, &level.x, &level.b, &level.r})
            total += list->capacity() * sizeof(float);
        for (const auto& list : level.colours) total += list.capacity() * sizeof(int);
    }
    return total;
}

void ColumnMultigrid::setup(const ColumnMatrix& finest) {
    const ColumnMatrix* A = &finest;
    for (std::size_t l = 0;; ++l) {
        if (l == levels_.size()) levels_.emplace_back();
        if (levels_[l].colours.empty()) colour(l == 0 ? finest : levels_[l].coarse, levels_[l]);
        A = l == 0 ? &finest : &levels_[l].coarse;
        factorise(*A, levels_[l]);
        if (A->n[0] == 1 && A->n[1] == 1) break;
        if (l + 1 == levels_.size()) levels_.emplace_back();
        A = l == 0 ? &finest : &levels_[l].coarse;
        coarsen(*A, levels_[l], levels_[l + 1].coarse);
    }
}

/// A checkerboard; columns at the joint of a periodic axis with an odd number of them have colours of their own.
void ColumnMultigrid::colour(const ColumnMatrix& A, Level& level) {
    const auto joint = [&](std::size_t h, int i) { return A.periodic[h] && A.n[h] % 2 == 1 && A.n[h] > 1 && i == A.n[h] - 1 ? 2 : 0; };
    level.colours.assign(8, {});
    for (int z = 0; z < A.n[1]; ++z)
        for (int x = 0; x < A.n[0]; ++x) level.colours[at((x + z) % 2 + joint(0, x) + 2 * joint(1, z))].push_back(x + z * A.n[0]);
    std::erase_if(level.colours, [](const auto& list) { return list.empty(); });
}

void ColumnMultigrid::factorise(const ColumnMatrix& A, Level& level) {
    const auto count = at(A.knots.count());
    for (auto* list : {&level.diagonal, &level.next, &level.inverse, &level.ratio, &level.x, &level.b, &level.r})
        resize_scratch(*list, count);
    resize_scratch(level.entry, A.entry.size());
    resize_scratch(level.first, count + 1);
    level.first[count] = static_cast<int>(A.entry.size());
    parallel_for(0, A.knots.columns(), [&](int c) {
        real next = 0, before = 0;  // entry and pivot of the knot below
        for (int k = A.knots.start[at(c)]; k < A.knots.start[at(c) + 1]; ++k) {
            const auto i = at(k);
            const real diagonal = A.vertical[i] + A.horizontal[i], pivot = diagonal - (before > 0 ? next * next / before : 0);
            // A column that touches neither air nor another column is singular: its last pivot is round-off.
            const bool sound = pivot > 64 * std::numeric_limits<real>::epsilon() * diagonal;
            before = sound ? pivot : 0;
            next = A.vertical_next[i] + A.horizontal_next[i];
            level.inverse[i] = static_cast<float>(sound ? 1 / pivot : 0);
            level.ratio[i] = static_cast<float>(sound ? next / pivot : 0);
            level.diagonal[i] = static_cast<float>(diagonal);
            level.next[i] = static_cast<float>(next);
            level.first[i] = A.begin[at(A.faces() * k)];
            for (int e = level.first[i]; e < A.begin[at(A.faces() * (k + 1))]; ++e) level.entry[at(e)] = static_cast<float>(A.entry[at(e)]);
        }
    });
}

void ColumnMultigrid::coarsen(const ColumnMatrix& A, Level& level, ColumnMatrix& to) {
    to.axes = A.axes;
    to.periodic = A.periodic;
    for (std::size_t h = 0; h < 2; ++h) to.n[h] = (A.n[h] + 1) / 2;
    merge_knots(A, to);
    map_knots(A, to, level);
    count_entries(A, level, to);
    add_entries(A, level, to);
}

/// Goes up the children of one parent together; add(row, length) for each of its knots.
template <class Add>
static void walk_children(const ColumnMatrix& A, const ColumnMatrix& to, int parent, Add&& add) {
    const auto row = [&](int i) { return A.knots.row[at(i)]; };
    std::array<int, 4> begin{}, k{}, end{};
    std::size_t count = 0;
    for_each_child(A, to, parent, [&](int child) {
        begin[count] = k[count] = A.knots.start[at(child)];
        end[count++] = A.knots.start[at(child) + 1];
    });
    constexpr int none = std::numeric_limits<int>::max();
    int last = none;  // row of the parent's last knot
    bool open = false;
    for (;;) {
        int y = none;
        for (std::size_t c = 0; c < count; ++c)
            if (k[c] < end[c]) y = std::min(y, row(k[c]));
        if (y == none) break;
        bool knot = true, goes_on = false;
        for (std::size_t c = 0; c < count; ++c) {
            if (k[c] < end[c] && row(k[c]) == y)
                goes_on = A.knots.length[at(k[c]++)] > 0 || goes_on;
            else if (k[c] > begin[c] && row(k[c] - 1) + A.knots.length[at(k[c] - 1)] > y)
                knot = false;  // this child covers the row between two knots of its own
        }
        if (!knot) continue;
        if (last != none) add(last, open ? y - last : 0);
        last = y, open = goes_on;
    }
    if (last != none) add(last, 0);
}

void ColumnMultigrid::merge_knots(const ColumnMatrix& A, ColumnMatrix& to) {
    const int columns = to.n[0] * to.n[1];
    Knots& knots = to.knots;
    knots.start.resize(at(columns) + 1);
    parallel_for(0, columns, [&](int c) {
        int count = 0;
        walk_children(A, to, c, [&](int, int) { ++count; });
        knots.start[at(c) + 1] = count;
    });
    knots.start[0] = 0;
    for (int c = 0; c < columns; ++c) knots.start[at(c) + 1] += knots.start[at(c)];
    resize_scratch(knots.row, at(knots.start.back()));
    resize_scratch(knots.length, knots.row.size());
    parallel_for(0, columns, [&](int c) {
        int k = knots.start[at(c)];
        walk_children(A, to, c, [&](int row, int length) {
            knots.row[at(k)] = row;
            knots.length[at(k++)] = length;
        });
    });
}

/// Where each knot lies between two of its parent's.
void ColumnMultigrid::map_knots(const ColumnMatrix& A, const ColumnMatrix& to, Level& level) {
    resize_scratch(level.parent, at(A.knots.count()));
    resize_scratch(level.share, level.parent.size());
    parallel_for(0, A.knots.columns(), [&](int c) {
        Cursor cursor(to.knots, parent_of(A, to, c));
        for (int i = A.knots.start[at(c)]; i < A.knots.start[at(c) + 1]; ++i) {
            cursor.move_to(A.knots.row[at(i)]);
            level.parent[at(i)] = cursor.knot();
            level.share[at(i)] = cursor.share(A.knots.row[at(i)]);
        }
    });
}

/// f(knot, weight) for the one or two knots of the parent that knot i is interpolated from.
template <class L, class F>
static void for_each_parent(const L& level, int i, F&& f) {
    const int K = level.parent[at(i)];
    const real share = level.share[at(i)];
    f(K, 1 - share);
    if (share > 0) f(K + 1, share);
}

/// How many knots stand beside each of the coarse level, and which is the lowest.
void ColumnMultigrid::count_entries(const ColumnMatrix& A, const Level& level, ColumnMatrix& to) {
    to.resize();
    const int faces = A.faces();
    auto &lowest = to.lowest, &highest = to.highest;
    refill_scratch(lowest, at(to.knots.count() * faces), std::numeric_limits<int>::max());
    refill_scratch(highest, lowest.size(), -1);
    parallel_for(0, to.knots.columns(), [&](int C) {
        for_each_child(A, to, C, [&](int c) {
            for (int f = 0; f < faces; ++f) {
                const int beside = A.neighbour(c, f);
                if (beside < 0 || parent_of(A, to, beside) == C) continue;
                for (int i = A.knots.start[at(c)]; i < A.knots.start[at(c) + 1]; ++i)
                    for (int e = A.begin[at(faces * i + f)]; e < A.begin[at(faces * i + f) + 1]; ++e) {
                        const int j = A.beside[at(e)], first = level.parent[at(j)], last = first + (level.share[at(j)] > 0 ? 1 : 0);
                        for_each_parent(level, i, [&](int K, real) {
                            auto &low = lowest[at(faces * K + f)], &high = highest[at(faces * K + f)];
                            low = std::min(low, first), high = std::max(high, last);
                        });
                    }
            }
        });
        for (int row = faces * to.knots.start[at(C)]; row < faces * to.knots.start[at(C) + 1]; ++row)
            to.begin[at(row) + 1] = std::max(0, highest[at(row)] - lowest[at(row)] + 1);
    });
    to.place_entries(lowest);
}

/// Pᵀ A_v P + ½ Pᵀ A_h P. Faces between two children of one parent join its own block.
void ColumnMultigrid::add_entries(const ColumnMatrix& A, const Level& level, ColumnMatrix& to) {
    const int faces = A.faces();
    parallel_for(0, to.knots.columns(), [&](int C) {
        const auto add = [&](std::vector<real>& diagonal, std::vector<real>& next, int i, int j, real value) {
            for_each_parent(level, i, [&](int K, real w) {
                for_each_parent(level, j, [&](int L, real v) {
                    if (K == L) diagonal[at(K)] += w * v * value;
                    if (L == K + 1) next[at(K)] += w * v * value;  // the other one is its mirror image
                });
            });
        };
        for_each_child(A, to, C, [&](int c) {
            for (int i = A.knots.start[at(c)]; i < A.knots.start[at(c) + 1]; ++i) {
                add(to.vertical, to.vertical_next, i, i, A.vertical[at(i)]);
                add(to.horizontal, to.horizontal_next, i, i, 0.5 * A.horizontal[at(i)]);
                if (A.vertical_next[at(i)] != 0) {
                    add(to.vertical, to.vertical_next, i, i + 1, A.vertical_next[at(i)]);
                    add(to.vertical, to.vertical_next, i + 1, i, A.vertical_next[at(i)]);
                }
                if (A.horizontal_next[at(i)] != 0) {
                    add(to.horizontal, to.horizontal_next, i, i + 1, 0.5 * A.horizontal_next[at(i)]);
                    add(to.horizontal, to.horizontal_next, i + 1, i, 0.5 * A.horizontal_next[at(i)]);
                }
            }
            for (int f = 0; f < faces; ++f) {
                const int beside = A.neighbour(c, f);
                if (beside < 0) continue;
                const bool inside = parent_of(A, to, beside) == C;
                for (int i = A.knots.start[at(c)]; i < A.knots.start[at(c) + 1]; ++i)
                    for (int e = A.begin[at(faces * i + f)]; e < A.begin[at(faces * i + f) + 1]; ++e) {
                        const int j = A.beside[at(e)];
                        const real value = 0.5 * A.entry[at(e)];
                        if (inside)
                            add(to.horizontal, to.horizontal_next, i, j, value);
                        else
                            for_each_parent(level, i, [&](int K, real w) {
                                for_each_parent(level, j, [&](int L, real v) { to.add_beside(K, f, L, w * v * value); });
                            });
                    }
            }
        });
    });
}

/// x of a column from b and the columns beside it: L D Lᵀ, upwards and down again. `alone`: those beside are zero.
void ColumnMultigrid::solve_column(const ColumnMatrix& A, Level& level, int column, bool alone) {
    const int first = A.knots.start[at(column)], last = A.knots.start[at(column) + 1];
    float *x = level.x.data(), below = 0;
    const float *b = level.b.data(), *ratio = level.ratio.data(), *inverse = level.inverse.data(), *entry = level.entry.data();
    const int *begin = level.first.data(), *beside = A.beside.data();
    for (int i = first; i < last; ++i) {
        float sum = b[i];
        if (!alone)
            for (int e = begin[i]; e < begin[i + 1]; ++e) sum -= entry[e] * x[beside[e]];
        if (i > first) sum -= ratio[i - 1] * below;
        x[i] = below = sum;
    }
    float above = 0;
    for (int i = last - 1; i >= first; --i) x[i] = above = x[i] * inverse[i] - ratio[i] * above;
}

/// r = b − A x
void ColumnMultigrid::residual(const ColumnMatrix& A, Level& level) {
    const float *x = level.x.data(), *b = level.b.data(), *entry = level.entry.data(), *next = level.next.data();
    const int *begin = level.first.data(), *beside = A.beside.data();
    parallel_for(0, A.knots.columns(), [&](int c) {
        const int first = A.knots.start[at(c)], last = A.knots.start[at(c) + 1];
        for (int i = first; i < last; ++i) {
            float sum = b[i] - level.diagonal[at(i)] * x[i];
            if (i > first) sum -= next[i - 1] * x[i - 1];
            if (i + 1 < last) sum -= next[i] * x[i + 1];
            for (int e = begin[i]; e < begin[i + 1]; ++e) sum -= entry[e] * x[beside[e]];
            level.r[at(i)] = sum;
        }
    });
}

void ColumnMultigrid::sweep(const ColumnMatrix& A, Level& level, bool upwards, bool from_zero) {
    const std::size_t count = level.colours.size();
    for (std::size_t c = 0; c < count; ++c) {
        const auto& columns = level.colours[upwards ? c : count - 1 - c];
        parallel_for(0, static_cast<int>(columns.size()), [&](int i) { solve_column(A, level, columns[at(i)], from_zero && c == 0); });
    }
}

void ColumnMultigrid::cycle(std::size_t l, const ColumnMatrix& A) {
    Level& level = levels_[l];
    if (l + 1 == levels_.size()) {
        solve_column(A, level, 0, true);
        return;
    }
    std::fill(level.x.begin(), level.x.end(), 0.0f);
    for (int s = 0; s < sweeps_; ++s) sweep(A, level, true, s == 0);
    residual(A, level);
    Level& next = levels_[l + 1];
    const ColumnMatrix& coarse = next.coarse;
    parallel_for(0, coarse.knots.columns(), [&](int C) {
        for (int K = coarse.knots.start[at(C)]; K < coarse.knots.start[at(C) + 1]; ++K) next.b[at(K)] = 0;
        for_each_child(A, coarse, C, [&](int c) {
            for (int i = A.knots.start[at(c)]; i < A.knots.start[at(c) + 1]; ++i)
                for_each_parent(level, i, [&](int K, real w) { next.b[at(K)] += static_cast<float>(w) * level.r[at(i)]; });
        });
    });
    cycle(l + 1, coarse);
    for_each_knot(A.knots, [&](std::size_t i) {
        const auto K = at(level.parent[i]);
        const float share = static_cast<float>(level.share[i]);
        level.x[i] += (1 - share) * next.x[K] + (share > 0 ? share * next.x[K + 1] : 0);
    });
    for (int s = 0; s < sweeps_; ++s) sweep(A, level, false, false);
}

void ColumnMultigrid::multiply(const ColumnMatrix& A, const std::vector<real>& x, std::vector<real>& y) {
    parallel_for(0, A.knots.columns(), [&](int c) {
        const int first = A.knots.start[at(c)], last = A.knots.start[at(c) + 1], faces = A.faces();
        for (int k = first; k < last; ++k) {
            const auto i = at(k);
            real sum = (A.vertical[i] + A.horizontal[i]) * x[i];
            if (k > first) sum += (A.vertical_next[i - 1] + A.horizontal_next[i - 1]) * x[i - 1];
            if (k + 1 < last) sum += (A.vertical_next[i] + A.horizontal_next[i]) * x[i + 1];
            for (int e = A.begin[at(faces * k)]; e < A.begin[at(faces * (k + 1))]; ++e) sum += A.entry[at(e)] * x[at(A.beside[at(e)])];
            y[i] = sum;
        }
    });
}

void ColumnMultigrid::precondition(const ColumnMatrix& A, const std::vector<real>& r, std::vector<real>& z) {
    Level& level = levels_[0];
    real largest = 0;  // single precision has no room for what is very small
    for (std::size_t i = 0; i < r.size(); ++i) largest = std::max(largest, std::abs(r[i]));
    const real scale = largest > 0 ? largest : 1;
    for_each_knot(A.knots, [&](std::size_t i) { level.b[i] = static_cast<float>(r[i] / scale); });
    cycle(0, A);
    for_each_knot(A.knots, [&](std::size_t i) { z[i] = scale * static_cast<real>(level.x[i]); });
}

const poisson::Report& ColumnMultigrid::solve(const ColumnMatrix& A, const std::vector<real>& b, std::vector<real>& x) {
    const auto count = at(A.knots.count());
    for (auto* list : {&r_, &p_, &Ap_, &z_}) resize_scratch(*list, count);
    report_ = {};
    const auto norm_of = [&](const std::vector<real>& v) { return std::sqrt(dot(A.knots, v, v)); };
    const auto residual = [&] {
        multiply(A, x, r_);
        for_each_knot(A.knots, [&](std::size_t i) { r_[i] = b[i] - r_[i]; });
        return norm_of(r_);
    };
    const real scale = norm_of(b);
    if (!std::isfinite(scale)) throw NumericalFailure("pressure", "the right-hand side is not finite");
    real size = residual();
    if (!(size < scale)) {
        std::fill(x.begin(), x.end(), 0.0);
        std::copy(b.begin(), b.end(), r_.begin());
        size = scale;
    }
    report_.residual_before = scale > 0 ? size / scale : 0;
    std::vector<real>& z = z_;
    real rz = 0, alpha = 0;
    while (size > options_.tolerance * scale) {
        if (report_.iterations == options_.max_iterations) {
            if (options_.fixed_iterations) break;
            throw NumericalFailure("pressure", "the residual is still " + std::to_string(size / scale) + " of the right-hand side after " +
                                                   std::to_string(report_.iterations) + " iterations");
        }
        precondition(A, r_, z);
        // Polak and Ribière's form, z·(r − r₋)/(z₋·r₋) with r − r₋ = −α A p: single precision leaves the preconditioner not quite the same.
        const real beta = report_.iterations == 0 ? 0 : -alpha * dot(A.knots, z, Ap_) / rz;
        rz = dot(A.knots, r_, z);
        for_each_knot(A.knots, [&](std::size_t i) { p_[i] = z[i] + (beta == 0 ? 0 : beta * p_[i]); });
        multiply(A, p_, Ap_);
        alpha = rz / dot(A.knots, p_, Ap_);
        if (!std::isfinite(alpha)) throw NumericalFailure("pressure", "conjugate gradients broke down");
        for_each_knot(A.knots, [&](std::size_t i) {
            x[i] += alpha * p_[i];
            r_[i] -= alpha * Ap_[i];
        });
        size = norm_of(r_);
        ++report_.iterations;
        if (options_.record_history) report_.history.push_back(size / scale);
    }
    size = residual();
    report_.converged = size <= 2 * options_.tolerance * scale;
    report_.residual_after = scale > 0 ? size / scale : 0;
    for (std::size_t i = 0; i < count; ++i) report_.residual_max = std::max(report_.residual_max, std::abs(r_[i]));
    return report_;
}

}  // namespace weir::tallcell
