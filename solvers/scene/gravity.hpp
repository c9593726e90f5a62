// The effect "gravity" as a scene writes it, the same for every solver that has it.
#pragma once
#include "scene/schema.hpp"

namespace weir::scene {

/// `doc`: what it does to this solver's water.
Variant gravity_effect(std::string doc);

}  // namespace weir::scene
