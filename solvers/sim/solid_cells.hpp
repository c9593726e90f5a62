// Cells of a grid covered by the solids of a scene, for drawing its fields.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace weir::sim {

/// 1 for each of the cells [begin, end), which must be whole planes, whose centre lies in a solid or body at time t; x fastest. An empty
/// function where the scene has neither.
std::function<std::vector<std::uint8_t>(const FieldSet& fields, real t, std::size_t begin, std::size_t end)> solid_cells(
    const scene::Scene& scene);

}  // namespace weir::sim
