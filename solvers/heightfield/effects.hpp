// What a scene may add to a height field: gravity, friction on the bed, rain.
#pragma once
#include "core/effects.hpp"
#include "heightfield/state.hpp"

namespace weir::heightfield {

std::vector<scene::Variant> effect_schemas();
/// Those of the scene that are passes of their own.
Effects<State> make_effects(const scene::Scene& scene, const State& state, const char* moved_in);

}  // namespace weir::heightfield
