// Detects solids and bodies thinner than the cells of the grid resolve.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace weir::mac {

/// Thickness in cells above which a solid's faces are located correctly along the grid, and for any slope. Bodies couple to the fluid by
/// the closed areas of faces, which require the latter.
inline constexpr real aligned_cells = 1, resolved_cells = 2;

/// One line for each solid whose largest thickness is below aligned_cells, and for each body below resolved_cells: its name, its thickness
/// in cells, and the cells needed. The thickness is twice the largest depth inside, searched from samples half a cell apart.
std::vector<std::string> remarks_on_thin_solids(const scene::Scene& scene);

}  // namespace weir::mac
