// What can be measured of a surface of triangles, or in 2D of lines.
#pragma once
#include "core/surface_mesh.hpp"

#include <cstdint>

namespace weir::reconstruction {

/// What it encloses, by the divergence theorem [m^3; m^2 of lines]; that of a closed surface does not depend on the origin.
real volume(const SurfaceMesh& mesh);
/// [m^2; m of lines]
real area(const SurfaceMesh& mesh);
/// Of the smallest triangle [m^2]; infinity where there is none.
real smallest_triangle(const SurfaceMesh& mesh);

/// How the triangles hang together.
struct Topology {
    std::int64_t edges = 0;
    std::int64_t open_edges = 0;     // that are not the side of exactly two triangles, or of two that run along it in the same direction
    std::int64_t euler = 0;          // points - edges + triangles: 2 for each sphere, less 2 for each hole through it
    std::int64_t unused_points = 0;  // of no triangle
};
/// Of lines: edges are the lines, open ones the points at which not one line ends and one begins, the Euler number 0 for loops.
Topology topology(const SurfaceMesh& mesh);

}  // namespace weir::reconstruction
