// Linear interpolation of the faces at the markers of one cell, eight markers at a time. The markers of a cell, and points within half a
// cell of them, read the same few faces around it: loads are shared and no interval search is needed. The weight of the node at distance k
// cells from the centre is a hat function of the marker's distance d:  w_k = max(0, 1 − |d − k|).
#pragma once
#include "surface/markers.hpp"
#include "surface/thin_walls.hpp"

#include <cstring>
#include <utility>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace weir::surface {

inline constexpr int marker_lanes = 8;
using Lanes = double __attribute__((vector_size(sizeof(double) * marker_lanes)));
using LaneBytes = std::int8_t __attribute__((vector_size(marker_lanes)));
using LaneIndex = std::int64_t __attribute__((vector_size(sizeof(double) * marker_lanes)));

/// One point per lane.
template <int D>
struct LaneVec : std::array<Lanes, D> {};

#define WEIR_LANES inline __attribute__((always_inline))

/// Loads `count` values; the remaining lanes repeat the last one. Only these `count` are accessed: the next marker may belong to another
/// thread.
WEIR_LANES Lanes load_lanes(const real* from, int count) {
#ifdef __AVX512F__
    const auto own = static_cast<__mmask8>((1u << count) - 1);
    const LaneIndex lane{0, 1, 2, 3, 4, 5, 6, 7}, last = LaneIndex{} + (count - 1), from_lane = lane < last ? lane : last;
    return _mm512_maskz_permutexvar_pd(0xff, reinterpret_cast<__m512i>(from_lane), _mm512_maskz_loadu_pd(own, from));
#else
    Lanes v;
    if (count == marker_lanes)
        std::memcpy(&v, from, sizeof v);
    else
        for (int l = 0; l < marker_lanes; ++l) v[l] = from[l < count ? l : count - 1];
    return v;
#endif
}
WEIR_LANES void store_lanes(real* to, const Lanes& v, int count) {
#ifdef __AVX512F__
    _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1u << count) - 1), v);
#else
    if (count == marker_lanes)
        std::memcpy(to, &v, sizeof v);
    else
        for (int l = 0; l < count; ++l) to[l] = v[l];
#endif
}
/// Returns whether |v| is at most `limit` in every lane; false for NaN.
WEIR_LANES bool all_within(const Lanes& v, real limit) {
#ifdef __AVX512F__
    return _mm512_cmp_pd_mask(_mm512_abs_pd(v), _mm512_set1_pd(limit), _CMP_LE_OQ) == 0xff;
#else
    bool within = true;
    for (int l = 0; l < marker_lanes; ++l) within = within && std::abs(v[l]) <= limit;
    return within;
#endif
}

/// Distance of points from the centre of cell I [cells].
template <int D>
WEIR_LANES LaneVec<D> from_centre(const Frame<D>& frame, const Index<D>& I, const LaneVec<D>& x) {
    LaneVec<D> d;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        d[at] = (x[at] - frame.origin[a]) * frame.inv_h[a] - (I[a] + 0.5);
    }
    return d;
}
template <int D>
WEIR_LANES LaneVec<D> load_positions(const Markers<D>& markers, std::size_t p, int count) {
    LaneVec<D> x;
    for (std::size_t a = 0; a < D; ++a) x[a] = load_lanes(markers.x[a].data() + p, count);
    return x;
}

/// Weights of the nodes around a cell for points at d [cells] from its centre: of those at −1, 0, 1 for centred nodes; for faces of those
/// at ± ½, or, for points up to a cell away, at ± ½ and ± 3/2.
template <int D, bool Wide>
struct Hats {
    std::array<std::array<Lanes, 3>, D> centre;
    std::array<std::array<Lanes, Wide ? 4 : 2>, D> face;

    WEIR_LANES explicit Hats(const LaneVec<D>& d) {
        const Lanes zero{};
        for (std::size_t axis = 0; axis < D; ++axis) {
            const Lanes x = d[axis];
            auto& c = centre[axis];
            c[0] = x < zero ? -x : zero;
            c[2] = x > zero ? x : zero;
            c[1] = 1 - (c[0] + c[2]);
            auto& f = face[axis];
            if constexpr (Wide) {
                f[0] = -0.5 - x > zero ? -0.5 - x : zero;
                f[3] = x - 0.5 > zero ? x - 0.5 : zero;
                f[1] = 0.5 - x - 2 * f[0] + f[3];
                f[2] = 0.5 + x - 2 * f[3] + f[0];
            } else {
                f[0] = 0.5 - x;
                f[1] = 0.5 + x;
            }
        }
    }
    /// Component A along axes 0 .. Axis; q is the cell's own node.
    template <int A, int Axis>
    WEIR_LANES Lanes along(const real* q, const std::array<std::ptrdiff_t, D>& stride) const {
        const auto node = [&](int k) {
            if constexpr (Axis == 0)
                return q[k];
            else
                return along<A, Axis - 1>(q + k * stride[Axis], stride);
        };
        if constexpr (Axis != A) {
            const auto& w = centre[Axis];
            return (w[0] * node(-1) + w[2] * node(1)) + w[1] * node(0);
        } else {
            const auto& w = face[Axis];
            if constexpr (Wide)
                return (w[0] * node(-1) + w[3] * node(2)) + (w[1] * node(0) + w[2] * node(1));
            else
                return w[0] * node(0) + w[1] * node(1);
        }
    }
};

/// Returns whether the nodes −1 .. 1 around a cell's own exist along an axis, and 2 for faces.
template <int D>
bool is_inner(const Frame<D>& frame, const Index<D>& I, int axis) {
    return I[axis] > 0 && I[axis] < frame.cells[axis] - 1;
}

/// Linear indices of the nodes −1 .. 2 along each axis around a cell's own; at the ends of an axis the last one repeats, or it wraps.
template <int D>
class NodeOffsets {
public:
    static constexpr int width = 4;
    template <class T>
    NodeOffsets(const Grid<T, D>& nodes, const Frame<D>& frame, const Index<D>& I) : straight_(is_inner(frame, I, 0)) {
        for (int d = 0; d < D; ++d) {
            const std::ptrdiff_t stride = nodes.stride(d);
            const bool ring = frame.periodic(d) && !is_inner(frame, I, d);
            const int end = ring ? frame.cells[d] : nodes.extent()[d];
            for (int k = 0; k < width; ++k) {
                const int i = I[d] + k - 1;
                along_[static_cast<std::size_t>(d)][static_cast<std::size_t>(k)] =
                    (ring ? (i + end) % end : std::clamp(i, 0, end - 1)) * stride;
            }
        }
    }
    std::ptrdiff_t operator()(int i, int j, int k) const { return along(0, i) + along(1, j) + (D == 2 ? 0 : along(2, k)); }
    /// Returns whether the nodes along x are contiguous.
    bool straight() const { return straight_; }

private:
    std::ptrdiff_t along(std::size_t d, int k) const { return along_[d][static_cast<std::size_t>(k + 1)]; }
    std::array<std::array<std::ptrdiff_t, width>, 3> along_;
    bool straight_;
};

/// The nodes around one cell, in place; at a side of the domain an extrapolated copy.
template <int D>
class CellNodes {
public:
    void look_at(const Grid<real, D>& nodes, const Frame<D>& frame, const Index<D>& I) {
        bool inner = true;
        for (int d = 0; d < D; ++d) inner = inner && is_inner(frame, I, d);
        if (!inner) return copy(nodes, frame, I);
        node_ = &nodes(I);
        for (int d = 0; d < D; ++d) stride_[static_cast<std::size_t>(d)] = nodes.stride(d);
    }
    /// Uses nodes that were computed, not stored.
    void look_at(const Around<D>& around) {
        node_ = &around.phi[around.at(Index<D>{})];
        for (int d = 0; d < D; ++d) stride_[static_cast<std::size_t>(d)] = around.stride(d);
    }
    /// Interpolation of velocity component A; of a cell field for A = −1.
    template <int A, bool Wide>
    WEIR_LANES Lanes at(const Hats<D, Wide>& hats) const {
        return hats.template along<A, D - 1>(node_, stride_);
    }

private:
    static constexpr int width = NodeOffsets<D>::width;

    void copy(const Grid<real, D>& nodes, const Frame<D>& frame, const Index<D>& I) {
        const NodeOffsets<D> offset(nodes, frame, I);
        std::ptrdiff_t own = 0;
        for (std::size_t d = 0, step = 1; d < D; ++d, step *= width) own += stride_[d] = static_cast<std::ptrdiff_t>(step);
        real* to = copy_.data();
        for (int k = D == 2 ? 0 : -1; k < (D == 2 ? 1 : width - 1); ++k)
            for (int j = -1; j < width - 1; ++j)
                for (int i = -1; i < width - 1; ++i) *to++ = nodes.data()[offset(i, j, k)];
        node_ = copy_.data() + own;
    }

    const real* node_;
    std::array<std::ptrdiff_t, D> stride_;
    std::array<real, (D == 2 ? width * width : width * width * width)> copy_;
};

/// The faces around one cell.
template <int D>
class CellFaces {
public:
    CellFaces(const MacVelocity<D>& u, const Frame<D>& frame, const Index<D>& I) {
        for (int a = 0; a < D; ++a) along_[static_cast<std::size_t>(a)].look_at(u[a], frame, I);
    }
    /// The velocity at points d [cells] from the cell's centre: at most half a cell, or, if Wide, a cell.
    template <bool Wide>
    WEIR_LANES LaneVec<D> velocity(const LaneVec<D>& d) const {
        const Hats<D, Wide> hats(d);
        LaneVec<D> v;
        v[0] = along_[0].template at<0>(hats);
        v[1] = along_[1].template at<1>(hats);
        if constexpr (D == 3) v[2] = along_[2].template at<2>(hats);
        return v;
    }

private:
    std::array<CellNodes<D>, D> along_;
};

}  // namespace weir::surface
