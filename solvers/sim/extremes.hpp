// Where a run that no longer advances is fastest: the largest velocity, pressure and depth that the solver shows, each with its place, and
// solids that move. For the message of a run that ends.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::sim {

/// "the fastest liquid moves at 3.1e+12 m/s at [0.51, 0.23] m (cell 16, 7); the highest pressure is ...; solids[0] moves at 1 m/s". Over
/// ranks all ask together.
std::string extremes(const scene::Scene& scene, const FieldSet& fields, real time);

}  // namespace weir::sim
