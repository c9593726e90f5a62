// Multilinear interpolation at points less than one cell from their home node. The stencil is then independent of the displacement, so rows
// are read contiguously, eight points at a time and without gathers (results agree with sample.hpp to round-off). Along an axis on which
// home and nodes are aligned the point lies between nodes −1, 0, 1 with the weights of a hat function,
//     w₋ = max(−d, 0),  w₀ = 1 − |d|,  w₊ = max(d, 0),            |d| ≤ 1;
// where they are staggered by half a cell it lies between the two nodes around the home: ½ − d and ½ + d, |d| ≤ ½.
// In a smooth flow eight neighbouring points mostly have displacements of one sign along every axis. Then one outer node has zero weight
// for all of them and is not read: 8 nodes instead of 27, with bitwise equal results.
#pragma once
#include "core/simd.hpp"
#include "staggered/sample.hpp"

namespace weir::staggered {

using simd::larger, simd::smaller, simd::magnitude, simd::Side;
using Lanes = simd::d8;
inline constexpr int lanes = simd::width<Lanes>;

/// A value and the range of the nodes with nonzero weight.
struct Bounded {
    Lanes value, low, high;
};

WEIR_INLINE Lanes blend(const Lanes& d, const Lanes& below, const Lanes& here, const Lanes& above) {
    const Lanes zero{};
    return (larger(-d, zero) * below + larger(d, zero) * above) + (1 - magnitude(d)) * here;
}
WEIR_INLINE Bounded blend(const Lanes& d, const Bounded& below, const Bounded& here, const Bounded& above) {
    const Lanes zero{};
    const Lanes low = d < zero ? below.low : d > zero ? above.low : here.low;
    const Lanes high = d < zero ? below.high : d > zero ? above.high : here.high;
    return {blend(d, below.value, here.value, above.value), smaller(here.low, low), larger(here.high, high)};
}
/// Where all points lie on the side of `other`, or all on their homes.
WEIR_INLINE Lanes blend_one_side(const Lanes& d, const Lanes& here, const Lanes& other) {
    return magnitude(d) * other + (1 - magnitude(d)) * here;
}
WEIR_INLINE Bounded blend_one_side(const Lanes& d, const Bounded& here, const Bounded& other) {
    return {blend_one_side(d, here.value, other.value), smaller(here.low, other.low), larger(here.high, other.high)};
}
WEIR_INLINE Lanes blend_halves(const Lanes& d, const Lanes& below, const Lanes& above) { return (0.5 - d) * below + (0.5 + d) * above; }

/// Eight neighbouring points of a row: displacements from their homes [cells], and the common sign of each component.
template <int D>
struct NearPoints {
    std::array<Lanes, D> d;
    std::array<Side, D> side;
    unsigned mixed = 0;  // bits of the axes with displacements of both signs

    WEIR_INLINED void find_sides() {
        for (std::size_t a = 0; a < D; ++a) {
            side[a] = simd::side_of(d[a]);
            mixed |= side[a] == Side::both ? 1U << a : 0U;
        }
    }
};

/// Interpolation at eight points. Bits of Aligned: axes along which homes and nodes are aligned; along the others they are staggered by
/// half a cell. q is the node with the index of the first home or, along the staggered axes, the lower of the two around it.
template <class Value, unsigned Aligned, int D>
class Near {
public:
    WEIR_INLINED Near(const NearPoints<D>& points, const std::array<int, D>& strides) : x(points) {
        for (std::size_t a = 0; a < D; ++a) {
            stride[a] = a == 0 ? 1 : strides[a];
            step[a] = static_cast<int>(points.side[a]) * stride[a];
        }
    }
    WEIR_INLINED Value at(const real* q) const {
        const unsigned mixed = x.mixed & Aligned;
        if (mixed == 0) return along<D - 1, 0>(q);
        if constexpr ((Aligned & (Aligned - 1)) != 0) {  // with several axes one with mixed signs is more frequent than all
            if (mixed == (Aligned & 1U)) return along<D - 1, Aligned & 1U>(q);
            if (mixed == (Aligned & 2U)) return along<D - 1, Aligned & 2U>(q);
            if (mixed == (Aligned & 4U)) return along<D - 1, Aligned & 4U>(q);
        }
        return along<D - 1, Aligned>(q);
    }

private:
    template <int Axis, unsigned Mixed>
    WEIR_INLINED Value along(const real* q) const {
        constexpr auto a = static_cast<std::size_t>(Axis);
        if constexpr (Axis < 0) {
            const Lanes v = simd::load<Lanes>(q);
            if constexpr (std::is_same_v<Value, Lanes>)
                return v;
            else
                return {v, v, v};
        } else {
            const auto node = [&](std::ptrdiff_t at) __attribute__((always_inline)) { return along<Axis - 1, Mixed>(q + at); };
            if constexpr ((Aligned >> Axis & 1U) == 0)
                return blend_halves(x.d[a], node(0), node(stride[a]));
            else if constexpr ((Mixed >> Axis & 1U) == 0)
                return blend_one_side(x.d[a], node(0), node(step[a]));
            else
                return blend(x.d[a], node(-stride[a]), node(0), node(stride[a]));
        }
    }

    const NearPoints<D>& x;
    std::array<std::ptrdiff_t, D> stride;
    std::array<std::ptrdiff_t, D> step;  // to the outer node on the points' side
};

/// The first node of `Near` for the first home of a row.
template <int D>
const real* near_node(const RowView<D>& v) {
    const real* q = v.q;
    for (std::size_t a = 0; a < D; ++a) q -= v.shift[a] > 0 ? v.stride[a] : 0;
    return q;
}

/// f(i, points, count) for each group of eight points of a row.
template <int D, class F>
WEIR_INLINE void for_each_near(const Displacement<D>& x, int count, F&& f) {
    for (int i = 0; i < count; i += lanes) {
        NearPoints<D> points;
        for (std::size_t a = 0; a < D; ++a) points.d[a] = simd::load(&x.d[a][i], count - i);
        points.find_sides();
        f(i, points, count - i);
    }
}

template <unsigned Aligned, int D>
void near_row(const RowView<D>& v, const Displacement<D>& x, int count, real* out) {
    const real* q = near_node(v);
    for_each_near(
        x, count, [&](int i, const NearPoints<D>& points, int rest) __attribute__((always_inline)) {
            simd::store(out + i, Near<Lanes, Aligned, D>(points, v.stride).at(q + i), rest);
        });
}

/// The value at each point of a row; nodes may be staggered along some axes.
template <int D>
void sample_near(const RowView<D>& v, const Displacement<D>& x, int count, real* out) {
    unsigned aligned = 0;
    for (int a = 0; a < D; ++a) aligned |= v.shift[static_cast<std::size_t>(a)] == 0 ? 1U << a : 0U;
    switch (aligned) {
        case 0:
            return near_row<0>(v, x, count, out);
        case 1:
            return near_row<1>(v, x, count, out);
        case 2:
            return near_row<2>(v, x, count, out);
        case 3:
            return near_row<3>(v, x, count, out);
        default:
            break;
    }
    if constexpr (D == 3) {
        switch (aligned) {
            case 4:
                return near_row<4>(v, x, count, out);
            case 5:
                return near_row<5>(v, x, count, out);
            case 6:
                return near_row<6>(v, x, count, out);
            case 7:
                return near_row<7>(v, x, count, out);
            default:
                break;
        }
    }
}

/// Value and bounds on nodes aligned with their homes.
template <int D>
void sample_near_bounded(const RowView<D>& v, const Displacement<D>& x, int count, real* out, real* low, real* high) {
    for_each_near(
        x, count, [&](int i, const NearPoints<D>& points, int rest) __attribute__((always_inline)) {
            const Bounded b = Near<Bounded, (1U << D) - 1, D>(points, v.stride).at(v.q + i);
            simd::store(out + i, b.value, rest);
            simd::store(low + i, b.low, rest);
            simd::store(high + i, b.high, rest);
        });
}

}  // namespace weir::staggered
