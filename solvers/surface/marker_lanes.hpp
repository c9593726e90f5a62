// Linear interpolation of the faces at the markers of one cell, eight markers at a time. The markers of a cell, and points within half a
// cell of them, read the same few faces around it: loads are shared and no interval search is needed. The weight of the node at distance k
// cells from the centre is a hat function of the marker's distance d:  w_k = max(0, 1 − |d − k|).
#pragma once
#include "core/simd.hpp"
#include "surface/markers.hpp"
#include "surface/thin_walls.hpp"

#include <cstring>
#include <utility>

namespace weir::surface {

using Lanes = simd::d8;
inline constexpr int marker_lanes = simd::width<Lanes>;
using LaneBytes = simd::Pack<std::int8_t, marker_lanes>;

/// One point per lane.
template <int D>
struct LaneVec : std::array<Lanes, D> {};

/// Distance of points from the centre of cell I [cells].
template <int D>
WEIR_INLINE LaneVec<D> from_centre(const Frame<D>& frame, const Index<D>& I, const LaneVec<D>& x) {
    LaneVec<D> d;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        d[at] = (x[at] - frame.origin[a]) * frame.inv_h[a] - (I[a] + 0.5);
    }
    return d;
}
template <int D>
WEIR_INLINE LaneVec<D> load_positions(const Markers<D>& markers, std::size_t p, int count) {
    LaneVec<D> x;
    for (std::size_t a = 0; a < D; ++a) x[a] = simd::load_first(markers.x[a].data() + p, count);
    return x;
}

/// Weights of the nodes around a cell for points at d [cells] from its centre: of those at −1, 0, 1 for centred nodes; for faces of those
/// at ± ½, or, for points up to a cell away, at ± ½ and ± 3/2.
template <int D, bool Wide>
struct Hats {
    std::array<std::array<Lanes, 3>, D> centre;
    std::array<std::array<Lanes, Wide ? 4 : 2>, D> face;

    WEIR_INLINE explicit Hats(const LaneVec<D>& d) {
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
    WEIR_INLINE Lanes along(const real* q, const std::array<std::ptrdiff_t, D>& stride) const {
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
    WEIR_INLINE Lanes at(const Hats<D, Wide>& hats) const {
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
    WEIR_INLINE LaneVec<D> velocity(const LaneVec<D>& d) const {
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
