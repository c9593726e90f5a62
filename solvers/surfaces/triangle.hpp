// Corners and areas of the triangles of a mesh, and ends of its lines.
#pragma once
#include "core/surface_mesh.hpp"

namespace weir::surfaces {

inline Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

inline const Vec<3>& corner(const SurfaceMesh& mesh, const std::array<int, 3>& triangle, std::size_t c) {
    return mesh.points[static_cast<std::size_t>(triangle[c])];
}

inline const Vec<3>& end(const SurfaceMesh& mesh, const std::array<int, 2>& line, std::size_t c) {
    return mesh.points[static_cast<std::size_t>(line[c])];
}

/// Twice the area, along the outward normal [m^2].
inline Vec<3> area_vector(const SurfaceMesh& mesh, const std::array<int, 3>& triangle) {
    const Vec<3>& a = corner(mesh, triangle, 0);
    return cross(corner(mesh, triangle, 1) - a, corner(mesh, triangle, 2) - a);
}

}  // namespace weir::surfaces
