// The effects of the solver "mac" by name, each in a file of its own.
#pragma once
#include "staggered/effects.hpp"

namespace weir::flow {

using namespace staggered;  // the grid's words are the solver's own

/// All of them, in the order in which they act in a stage: gravity first.
const EffectKinds& effect_kinds();

EffectKind buoyancy();
EffectKind confinement();
EffectKind diffusion();
EffectKind cooling();
EffectKind decay();
EffectKind viscosity();

}  // namespace weir::flow
