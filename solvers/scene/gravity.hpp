// The schema of the effect "gravity", common to all solvers that have it.
#pragma once
#include "scene/schema.hpp"

namespace weir::scene {

/// `doc`: its description for this solver.
Variant gravity_effect(std::string doc);

}  // namespace weir::scene
