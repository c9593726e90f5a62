// Interpolation on rows of points. A point is its home node (whose value is being computed) plus a displacement d in cells.
//
// Mirror symmetry is bitwise. Along an axis the nodes lie at home + shift + integer. With k = rint(d − shift), the remainder r = d − (k +
// shift) is exact in sign. A mirrored point then has −r, the same two weights |r| and 1 − |r|, and the same two nodes swapped. Sums are
// taken in pairs that commute under the swap.
#pragma once
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "mac/grid/ghosts.hpp"
#include "mac/grid/rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace weir::mac {

/// The positions of a row of points: displacement from their home nodes along each axis [cells].
template <int D>
struct Displacement {
    alignas(64) real d[D][row_block];
    bool near = false;  // no component exceeds one cell (traces: half a cell at the midpoint)
};

/// A padded field relative to a row of home nodes. q is the node with the index of the row's first home node; along axis d the nodes lie at
/// home + shift[d] + integers, with shift 0 or ± ½.
template <int D>
struct RowView {
    const real* q;
    std::array<int, D> stride;
    std::array<real, D> shift;

    /// Component or cell field on `node_axis` (−1: cell centres), relative to homes on `home_axis`.
    RowView(const Padded<D>& field, const Index<D>& first, int node_axis, int home_axis) : q(field.at(first)) {
        for (int d = 0; d < D; ++d) {
            const auto at = static_cast<std::size_t>(d);
            stride[at] = static_cast<int>(field.stride(d));
            shift[at] = (d == node_axis ? 0.0 : 0.5) - (d == home_axis ? 0.0 : 0.5);
        }
    }
};

/// The two nodes around a point along one axis: offset of the lower one from the home index, and the weights of both.
struct Between {
    int lower;
    real w0, w1;
};
inline Between between(real d, real shift) {
    const real k = std::rint(d - shift);
    const real r = d - (k + shift);
    return {static_cast<int>(r < 0 ? k - 1 : k), r < 0 ? -r : 1 - r, r < 0 ? 1 + r : r};
}

/// Multilinear interpolation at point i of a row.
template <int D>
inline real linear(const RowView<D>& v, const Displacement<D>& x, int i) {
    const Between bx = between(x.d[0][i], v.shift[0]), by = between(x.d[1][i], v.shift[1]);
    int m = i + bx.lower + by.lower * v.stride[1];
    const int sy = v.stride[1];
    const auto plane = [&](int at) {
        return by.w0 * (bx.w0 * v.q[at] + bx.w1 * v.q[at + 1]) + by.w1 * (bx.w0 * v.q[at + sy] + bx.w1 * v.q[at + sy + 1]);
    };
    if constexpr (D == 2) {
        return plane(m);
    } else {
        const Between bz = between(x.d[2][i], v.shift[2]);
        m += bz.lower * v.stride[2];
        return bz.w0 * plane(m) + bz.w1 * plane(m + v.stride[2]);
    }
}

template <int D>
void sample_linear(const RowView<D>& v, const Displacement<D>& x, int count, real* out) {
#pragma omp simd
    for (int i = 0; i < count; ++i) out[i] = linear(v, x, i);
}

/// The minimum and maximum of the nodes with nonzero weight around each point.
template <int D>
void sample_bounds(const RowView<D>& v, const Displacement<D>& x, int count, real* low, real* high) {
#pragma omp simd
    for (int i = 0; i < count; ++i) {
        const Between bx = between(x.d[0][i], v.shift[0]), by = between(x.d[1][i], v.shift[1]);
        const int sx = bx.w1 > 0 ? 1 : 0, sy = by.w1 > 0 ? v.stride[1] : 0;
        const auto least = [&](int at) {  // of the nodes of one plane; pure, since g++ 12 mishandles captured variables in simd loops
            return std::min(std::min(v.q[at], v.q[at + sx]), std::min(v.q[at + sy], v.q[at + sx + sy]));
        };
        const auto most = [&](int at) { return std::max(std::max(v.q[at], v.q[at + sx]), std::max(v.q[at + sy], v.q[at + sx + sy])); };
        const int m = i + bx.lower + by.lower * v.stride[1];
        if constexpr (D == 2) {
            low[i] = least(m);
            high[i] = most(m);
        } else {
            const Between bz = between(x.d[2][i], v.shift[2]);
            const int below = m + bz.lower * v.stride[2], above = below + (bz.w1 > 0 ? v.stride[2] : 0);
            low[i] = std::min(least(below), least(above));
            high[i] = std::max(most(below), most(above));
        }
    }
}

/// Lagrange cubic through four equidistant values; g and f = 1 − g are the weights of the middle two.
inline real lagrange_cubic(real qm, real q0, real q1, real q2, real g, real f) {
    const real fg = f * g;
    return (0.5 * (1 + f) * g * (1 + g) * q0 + 0.5 * (1 + g) * f * (1 + f) * q1) - (fg * (1 + g) * qm + fg * (1 + f) * q2) / 6;
}

/// Hermite cubic with central slopes; a slope is set to zero where its sign differs from that of the interval: monotone (Fedkiw, Stam &
/// Jensen 2001, appendix B).
inline real monotone_cubic(real qm, real q0, real q1, real q2, real g, real f) {
    const real delta = q1 - q0, s0 = 0.5 * (q1 - qm), s1 = 0.5 * (q2 - q0);
    const real d0 = s0 * delta > 0 ? s0 : 0, d1 = s1 * delta > 0 ? s1 : 0;
    return (g * g * (1 + 2 * f) * q0 + f * f * (1 + 2 * g) * q1) + f * g * (g * d0 - f * d1);
}

/// Cubic interpolation, axis by axis (x, then y, then z), with one of the two cubics above.
template <int D, class Cubic>
void sample_cubic(const RowView<D>& v, const Displacement<D>& x, int count, Cubic cubic, real* out) {
    for (int i = 0; i < count; ++i) {
        const Between bx = between(x.d[0][i], v.shift[0]), by = between(x.d[1][i], v.shift[1]);
        const auto line = [&](const real* q) { return cubic(q[-1], q[0], q[1], q[2], bx.w0, bx.w1); };
        const std::ptrdiff_t sy = v.stride[1];
        const auto plane = [&](const real* q) { return cubic(line(q - sy), line(q), line(q + sy), line(q + 2 * sy), by.w0, by.w1); };
        const real* q = v.q + i + bx.lower + by.lower * sy;
        if constexpr (D == 2) {
            out[i] = plane(q);
        } else {
            const Between bz = between(x.d[2][i], v.shift[2]);
            const std::ptrdiff_t sz = v.stride[2];
            q += bz.lower * sz;
            out[i] = cubic(plane(q - sz), plane(q), plane(q + sz), plane(q + 2 * sz), bz.w0, bz.w1);
        }
    }
}

}  // namespace weir::mac
