// The extremes of a run that no longer advances: the largest velocity, pressure and depth with their places, and moving solids. For the
// error message at the end of the run.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::sim {

/// "the fastest liquid moves at 3.1e+12 m/s at [0.51, 0.23] m (cell 16, 7); the highest pressure is ...; solids[0] moves at 1 m/s". In
/// parallel the call is collective.
std::string extremes(const scene::Scene& scene, const FieldSet& fields, real time);

}  // namespace weir::sim
