// A rank's part of a contour: its own layers of the lattice and the adjacent ones, with the same points in the same order as on their
// owners. A whole contour is the piece of one rank.
#pragma once
#include "core/surface_mesh.hpp"
#include "parallel/partition.hpp"

#include <cstddef>

namespace weir::surfaces {

/// Points are ordered by layer, and triangles or lines by the layer of their cell. In 3D a layer's points lie on edges that begin in its
/// plane; in a plane of samples they are those of its cells that do not belong to the previous layer.
struct Piece {
    /// Own points are [begin, end): [begin, first_end) in the first own layer and [last_begin, end) in the last. Points of the adjacent
    /// layers are [below, begin) and [end, above).
    std::size_t below = 0, begin = 0, first_end = 0, last_begin = 0, end = 0, above = 0;
    /// Own triangles or lines.
    std::size_t cells_begin = 0, cells_end = 0;

    std::size_t points() const { return end - begin; }
};

/// start(k): number of points before layer k.
template <class Start>
Piece piece_of(PlaneRange layers, const Start& start, std::size_t cells_begin, std::size_t cells_end) {
    return {start(layers.begin - 1),
            start(layers.begin),
            start(layers.begin + 1),
            start(layers.end - 1),
            start(layers.end),
            start(layers.end + 1),
            cells_begin,
            cells_end};
}

/// The whole mesh as one piece.
inline Piece whole_of(const SurfaceMesh& mesh) {
    const std::size_t count = mesh.points.size();
    return {0, 0, count, 0, count, count, 0, mesh.corners.size() + mesh.lines.size()};
}

}  // namespace weir::surfaces
