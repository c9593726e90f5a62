// The effects of a height field: gravity, bed friction, rain.
#pragma once
#include "core/effects.hpp"
#include "heightfield/state.hpp"

namespace weir::heightfield {

std::vector<scene::Variant> effect_schemas();
/// The scene's effects that are passes of their own.
Effects<State> make_effects(const scene::Scene& scene, const State& state, const char* moved_in);

}  // namespace weir::heightfield
