// The effects of the solver "mac_water" by name.
#pragma once
#include "staggered/effects.hpp"
#include "surface/frame.hpp"

namespace weir::water {

using namespace surface;  // the words of the grid and of its free surface are the solver's own

/// Forces on the liquid's bulk, which act between momentum and pressure.
const EffectKinds& body_forces();

/// What a scene may name: body forces, and what is solved for inside other passes: surface tension (a jump of the pressure), viscosity;
/// and what moves the surface: volume control.
std::vector<scene::Variant> effect_schemas();

}  // namespace weir::water
