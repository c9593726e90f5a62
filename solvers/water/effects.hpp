// The effects of the solver "mac_water" by name.
#pragma once
#include "free_surface/frame.hpp"
#include "mac/grid/effects.hpp"

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

/// Forces on the bulk of the liquid, applied between momentum and pressure.
const EffectKinds& body_forces();

/// The effects that a scene may name: body forces; terms of other passes, namely surface tension (a jump of the pressure) and viscosity;
/// and volume control, which moves the surface.
std::vector<scene::Variant> effect_schemas();

}  // namespace weir::water
