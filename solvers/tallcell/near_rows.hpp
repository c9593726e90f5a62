// Eight faces of one kind beside one another along x, traced and sampled together: where no point moves farther than one cell, the samples
// that it can lie between are the three (or, from faces of another kind, two) nearest along each axis, and their weights are hats. So all
// loads are of neighbours in memory.
#pragma once
#include "staggered/velocity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace weir::tallcell {

inline constexpr int row_lanes = 8;
using Eight = std::array<real, row_lanes>;

/// Displacements [cells] of eight faces.
template <int D>
using Moved = std::array<Eight, D>;

/// Weights of the nodes along one axis, and the offset of the first: of the node's own kind at −1, 0, 1; of the other at ± ½.
struct Hats {
    std::array<Eight, 3> weight;
    int first, count;
    Hats(const Eight& d, bool own, bool above) : first(own || !above ? -1 : 0), count(own ? 3 : 2) {
        for (std::size_t i = 0; i < row_lanes; ++i) {
            weight[0][i] = own ? std::max(0.0, -d[i]) : 0.5 - d[i];
            weight[1][i] = own ? 1 - std::abs(d[i]) : 0.5 + d[i];
            weight[2][i] = std::max(0.0, d[i]);
        }
    }
};

template <int D>
std::array<Hats, D> hats_of(const Moved<D>& d, int home, int component) {
    const auto hat = [&](int axis) {
        const bool own = home == component || (axis != home && axis != component);
        return Hats(d[static_cast<std::size_t>(axis)], own, axis == component);
    };
    if constexpr (D == 2)
        return {hat(0), hat(1)};
    else
        return {hat(0), hat(1), hat(2)};
}

/// Component `component` at the displaced points; q is that component's sample with the index of the first face. Points may lie at most
/// half a cell away where the face is of another kind, one cell where it is its own.
template <int D>
inline void sample_near(const real* q, std::ptrdiff_t sy, std::ptrdiff_t sz, const std::array<Hats, D>& hats, Eight& out) {
    out.fill(0);
    const int planes = D == 3 ? hats[D - 1].count : 1;
    for (int k = 0; k < planes; ++k) {
        Eight plane{};
        const real* at_plane = D == 3 ? q + (hats[D - 1].first + k) * sz : q;
        for (int j = 0; j < hats[1].count; ++j) {
            const real* row = at_plane + (hats[1].first + j) * sy + hats[0].first;
            const auto &x0 = hats[0].weight[0], &x1 = hats[0].weight[1], &x2 = hats[0].weight[2];
            const auto& y = hats[1].weight[static_cast<std::size_t>(j)];
            if (hats[0].count == 3) {
#pragma omp simd
                for (std::size_t i = 0; i < row_lanes; ++i) plane[i] += y[i] * (x0[i] * row[i] + x1[i] * row[i + 1] + x2[i] * row[i + 2]);
            } else {
#pragma omp simd
                for (std::size_t i = 0; i < row_lanes; ++i) plane[i] += y[i] * (x0[i] * row[i] + x1[i] * row[i + 1]);
            }
        }
        const auto& z = hats[D - 1].weight[static_cast<std::size_t>(k)];
#pragma omp simd
        for (std::size_t i = 0; i < row_lanes; ++i) out[i] = D == 3 ? out[i] + z[i] * plane[i] : plane[i];
    }
}

/// The smallest and the largest of the own samples whose weight is not zero.
template <int D>
inline void bounds_near(const real* q, std::ptrdiff_t sy, std::ptrdiff_t sz, const std::array<Hats, D>& hats, Eight& low, Eight& high) {
    low.fill(infinity), high.fill(-infinity);
    for (int k = 0; k < (D == 3 ? 3 : 1); ++k)
        for (int j = 0; j < 3; ++j) {
            const real* row = q + (D == 3 ? (k - 1) * sz : 0) + (j - 1) * sy - 1;
            const auto& y = hats[1].weight[static_cast<std::size_t>(j)];
            const auto& z = hats[D - 1].weight[static_cast<std::size_t>(k)];
            const auto &x0 = hats[0].weight[0], &x2 = hats[0].weight[2];
#pragma omp simd
            for (std::size_t i = 0; i < row_lanes; ++i) {
                const bool counts = y[i] > 0 && (D == 2 || z[i] > 0);
                const real middle = row[i + 1];
                const real a = x0[i] > 0 ? row[i] : middle, b = x2[i] > 0 ? row[i + 2] : middle;
                // Of a displacement by a whole cell the middle weighs nothing; it lies beside what does, and is let in.
                const real least = std::min(middle, std::min(a, b)), most = std::max(middle, std::max(a, b));
                low[i] = counts ? std::min(low[i], least) : low[i];
                high[i] = counts ? std::max(high[i], most) : high[i];
            }
        }
}

}  // namespace weir::tallcell
