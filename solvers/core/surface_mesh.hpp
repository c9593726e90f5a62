// A surface of triangles, or in 2D of lines: closed, its front outside the liquid.
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
    std::vector<real> thickness;              // liquid along the inward normal of each point [m]
    /// Over ranks that have a part each: so many points have those before this one; corners and lines are numbers among those of all.
    std::size_t first = 0;
};

}  // namespace weir
