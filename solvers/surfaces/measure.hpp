// Measures of a surface of triangles, or in 2D of lines.
#pragma once
#include "core/surface_mesh.hpp"

#include <cstdint>

namespace weir::surfaces {

/// Enclosed volume, by the divergence theorem [m^3; m^2 for lines]; for a closed surface it does not depend on the origin.
real volume(const SurfaceMesh& mesh);
/// [m^2; m of lines]
real area(const SurfaceMesh& mesh);
/// Area of the smallest triangle [m^2]; infinity without triangles.
real smallest_triangle(const SurfaceMesh& mesh);

/// The topology of the triangles.
struct Topology {
    std::int64_t edges = 0;
    std::int64_t open_edges = 0;     // edges that do not belong to exactly two triangles in opposite directions
    std::int64_t euler = 0;          // points - edges + triangles: 2 for each sphere, minus 2 for each hole through it
    std::int64_t unused_points = 0;  // of no triangle
};
/// For lines: edges are the lines, open ones the points without exactly one incoming and one outgoing line, the Euler number 0 for loops.
Topology topology(const SurfaceMesh& mesh);

}  // namespace weir::surfaces
