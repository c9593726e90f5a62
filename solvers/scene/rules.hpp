// Rules that tie several keys of a scene together: both ends of a periodic axis, corners of a box, the size of memory.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace weir::scene {

/// Adds what is wrong to `problems`; and makes equal what may be said in two ways: `grid.periodic` and sides of kind "periodic" agree
/// afterwards, and a side that is "open" is an "outflow". dim 0: not known.
void check_rules(Table& root, int dim, const std::string& file, std::vector<Problem>& problems);

}  // namespace weir::scene
