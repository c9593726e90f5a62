#include "two_phase/curvature.hpp"

#include "two_phase/fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weir::two_phase {

namespace {

constexpr real ends_within = 1e-8;  // of 0 or 1: a column ends there

/// Height of the liquid above the middle of cell I along `sign` times the axis, in cells. False where the column does not lead from a full
/// to an empty cell, or is not monotone.
template <int D>
bool find_height(const Interface<D>& s, const Index<D>& I, int axis, int sign, real& result) {
    const auto at = [&](int k) {
        Index<D> J = I;
        J[axis] += sign * k;
        return s.f(s.around(J));
    };
    const real middle = at(0);
    bool ends_empty = middle <= ends_within, ends_full = middle >= 1 - ends_within;
    result = middle - 0.5;
    real last = middle;
    for (int k = 1; k <= column_reach && !ends_empty; ++k) {
        const real f = at(k);
        if (f > last + ends_within && last < 1 - ends_within) return false;
        result += last = f;
        ends_empty = f <= ends_within;
    }
    last = middle;
    for (int k = 1; k <= column_reach && !ends_full; ++k) {
        const real f = at(-k);
        if (f < last - ends_within && last > ends_within) return false;
        result -= 1 - f;
        last = f;
        ends_full = f >= 1 - ends_within;
    }
    return ends_empty && ends_full;
}

/// Curvature of the heights of 3 (2D) or 3 x 3 columns around I along an axis; false where one has no height.
template <int D>
bool curvature_along(const Interface<D>& s, const Index<D>& I, int axis, int sign, real& kappa) {
    const int t = (axis + 1) % D, r = D == 3 ? (axis + 2) % D : -1;
    real h[3][3] = {};
    for (int j = D == 3 ? -1 : 0; j <= (D == 3 ? 1 : 0); ++j)
        for (int i = -1; i <= 1; ++i) {
            Index<D> J = I;
            J[t] += i;
            if (r >= 0) J[r] += j;
            real& height = h[j + 1][i + 1];
            if (!find_height(s, s.around(J), axis, sign, height)) return false;
            height *= s.h[axis];
        }
    const real dx = s.h[t], dy = r >= 0 ? s.h[r] : 1;
    Graph g{.x = 0.5 * (h[1][2] - h[1][0]) / dx, .xx = ((h[1][2] + h[1][0]) - 2 * h[1][1]) / (dx * dx)};
    if (r >= 0) {
        g.y = 0.5 * (h[2][1] - h[0][1]) / dy;
        g.yy = ((h[2][1] + h[0][1]) - 2 * h[1][1]) / (dy * dy);
        g.xy = 0.25 * ((h[2][2] + h[0][0]) - (h[2][0] + h[0][2])) / (dx * dy);
    }
    kappa = curvature_of(g);
    return true;
}

}  // namespace

template <int D>
bool is_interfacial(const Padded<D>& f, const Index<D>& I) {
    if (is_empty(f(I))) return false;
    if (!is_full(f(I))) return true;
    for (int d = 0; d < D; ++d)
        if (is_empty(f(I - e<D>(d))) || is_empty(f(I + e<D>(d)))) return true;
    return false;
}

template <int D>
real curvature_by_heights(const Interface<D>& s, const Index<D>& I) {
    const Vec<D> m = physical_normal(s, I);
    std::array<int, D> axes;
    std::iota(axes.begin(), axes.end(), 0);
    std::sort(axes.begin(), axes.end(), [&](int a, int b) { return std::abs(m[a]) > std::abs(m[b]); });
    real kappa = no_curvature;
    for (const int axis : axes)
        if (curvature_along(s, I, axis, m[axis] > 0 ? 1 : -1, kappa)) return kappa;
    return no_curvature;
}

namespace {

/// Mean over those of the 3^D cells around I that have one.
template <int D>
real mean_around(const Grid<real, D>& kappa, const Around<D>& around, const Index<D>& I) {
    real sum = 0;
    int count = 0;
    for (int k = 0; k < block_cells<D>; ++k) {
        const real there = kappa(around(I + block_offset<D>(k)));
        if (there != no_curvature) sum += there, ++count;
    }
    return count > 0 ? sum / count : no_curvature;
}

}  // namespace

/// The mean reads curvatures by heights and fits only, so cells do not depend on the order in which they are visited.
template <int D>
void find_curvature(const Interface<D>& s, WithoutHeights otherwise, Curvature<D>& result) {
    const auto cells = s.f.extent();
    for_each_cell(cells, [&](const Index<D>& I) {
        real& kappa = result.found(I) = no_curvature;
        if (!is_interfacial(s.padded, I)) return;
        kappa = curvature_by_heights(s, I);
        if (kappa == no_curvature && otherwise == WithoutHeights::fit) kappa = curvature_by_fit(s, I);
    });
    refresh(result.found, s.around.repeats());
    for_each_cell(cells, [&](const Index<D>& I) {
        const real found = result.found(I);
        const bool missing = found == no_curvature && is_interfacial(s.padded, I);
        result.kappa(I) = missing ? mean_around(result.found, s.around, I) : found;
    });
}

#define WEIR_INSTANTIATE(D)                                                   \
    template bool is_interfacial(const Padded<D>&, const Index<D>&);          \
    template real curvature_by_heights(const Interface<D>&, const Index<D>&); \
    template void find_curvature(const Interface<D>&, WithoutHeights, Curvature<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
