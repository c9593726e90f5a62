// A closed surface of triangles, or in 2D of lines, oriented outward from the liquid.
#pragma once
#include "core/types.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace weir {

struct SurfaceMesh {
    std::vector<Vec<3>> points;               // [m]
    std::vector<std::array<int, 3>> corners;  // of each triangle, counterclockwise as seen from outside
    std::vector<std::array<int, 2>> lines;    // in 2D, instead of triangles: from point to point, the liquid on their left
    std::vector<Vec<3>> normals;              // of each point, outwards, of length one
    std::vector<Vec<3>> velocity;             // of the liquid at each point [m/s]; empty where it is not known
    std::vector<real> thickness;              // thickness of the liquid along the inward normal of each point [m]
    /// In parallel, where each rank has a part: number of points of the previous ranks. Corners and lines are global indices.
    std::size_t first = 0;
};

}  // namespace weir
