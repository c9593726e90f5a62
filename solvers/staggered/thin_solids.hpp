// What a scene on a grid says without meaning it: solids thinner than its cells resolve.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace weir::staggered {

/// Cells across a solid from which its faces stand where they are along the grid, and at any slope.
inline constexpr double aligned_cells = 1, resolved_cells = 2;

/// One line for each solid that is thinner at its thickest than aligned_cells: its name, its thickness in cells, and the cells needed. The
/// thickness is twice the largest distance to the surface found inside, from samples half a cell apart on.
std::vector<std::string> remarks_on_thin_solids(const scene::Scene& scene);

}  // namespace weir::staggered
