// Traces and samples eight faces of one kind, adjacent along x. Where no point moves farther than one cell, the stencil consists of the
// three nearest samples (or two, for faces of another kind) along each axis, with hat functions as weights. So all loads are contiguous.
#pragma once
#include "core/simd.hpp"
#include "staggered/velocity.hpp"

#include <array>
#include <type_traits>

namespace weir::tallcell {

using simd::larger, simd::smaller, simd::magnitude;
using Eight = simd::d8;
inline constexpr int row_lanes = simd::width<Eight>;

/// Displacements [cells] of eight faces.
template <int D>
using Moved = std::array<Eight, D>;

/// Weights of the nodes along one axis, and the offset of the first: −1, 0, 1 for the same kind of node; ± ½ for the other.
template <bool Own>
struct Hat {
    static constexpr int count = Own ? 3 : 2;
    std::array<Eight, count> weight;
    int first;
    WEIR_INLINE Hat(const Eight& d, bool above) : first(Own || !above ? -1 : 0) {
        const Eight none{};
        if constexpr (Own)
            weight = {larger(none, -d), 1 - magnitude(d), larger(none, d)};
        else
            weight = {0.5 - d, 0.5 + d};
    }
};

/// Σ of the weights along x, y and z times the samples; q is the first sample of the first face.
template <int D, bool X, bool Y, bool Z>
WEIR_INLINE Eight sum_of_hats(const real* q, std::ptrdiff_t sy, std::ptrdiff_t sz, const Hat<X>& x, const Hat<Y>& y, const Hat<Z>& z) {
    Eight sum{};
    for (int k = 0; k < (D == 3 ? Hat<Z>::count : 1); ++k) {
        Eight plane{};
        for (int j = 0; j < Hat<Y>::count; ++j) {
            const real* row = q + (D == 3 ? (z.first + k) * sz : 0) + (y.first + j) * sy + x.first;
            Eight line{};
            for (int i = 0; i < Hat<X>::count; ++i) line += x.weight[static_cast<std::size_t>(i)] * simd::load<Eight>(row + i);
            plane += y.weight[static_cast<std::size_t>(j)] * line;
        }
        if constexpr (D == 2) return plane;
        sum += z.weight[static_cast<std::size_t>(k)] * plane;
    }
    return sum;
}

/// Component `component` at points displaced by d from eight faces along axis `home`; q is that component's sample with the index of the
/// first face. Displacements are at most half a cell for faces of another kind, and one cell for the same kind.
template <int D>
inline Eight sample_near(const real* q, std::ptrdiff_t sy, std::ptrdiff_t sz, const Moved<D>& d, int home, int component) {
    const auto sum = [&](auto x_own, auto y_own, auto z_own) {
        return sum_of_hats<D>(q, sy, sz, Hat<decltype(x_own)::value>(d[0], component == 0),
                              Hat<decltype(y_own)::value>(d[1], component == 1), Hat<decltype(z_own)::value>(d[D - 1], component == D - 1));
    };
    constexpr std::true_type own{};
    constexpr std::false_type other{};
    if (home == component) return sum(own, own, own);
    if (D == 2 || home + component == 1) return sum(other, other, own);
    return home + component == 2 ? sum(other, own, other) : sum(own, other, other);
}

/// The minimum and maximum of the own samples with nonzero weight.
template <int D>
inline void bounds_near(const real* q, std::ptrdiff_t sy, std::ptrdiff_t sz, const Moved<D>& d, Eight& low, Eight& high) {
    const Hat<true> x(d[0], false), y(d[1], false), z(d[D - 1], false);
    const Eight none{};
    low = none + infinity, high = none - infinity;
    for (std::size_t k = 0; k < (D == 3 ? 3 : 1); ++k)
        for (std::size_t j = 0; j < 3; ++j) {
            const real* row = q + (D == 3 ? (static_cast<std::ptrdiff_t>(k) - 1) * sz : 0) + (static_cast<std::ptrdiff_t>(j) - 1) * sy;
            const auto counts = D == 3 ? (y.weight[j] > none) & (z.weight[k] > none) : y.weight[j] > none;
            // for a displacement by a whole cell the middle has zero weight; it is adjacent and is included
            const Eight middle = simd::load<Eight>(row);
            const Eight a = x.weight[0] > none ? simd::load<Eight>(row - 1) : middle,
                        b = x.weight[2] > none ? simd::load<Eight>(row + 1) : middle;
            low = counts ? smaller(low, smaller(middle, smaller(a, b))) : low;
            high = counts ? larger(high, larger(middle, larger(a, b))) : high;
        }
}

}  // namespace weir::tallcell
