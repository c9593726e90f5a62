// The effects of the solver "mac" by name, each in a file of its own.
#pragma once
#include "staggered/advection.hpp"
#include "staggered/effects.hpp"

namespace weir::flow {

using namespace staggered;  // the grid's words are the solver's own

/// The stages of its step: all.
inline const std::vector<Stage> stages{Stage::source, Stage::force, Stage::carried, Stage::implicit, Stage::finish};

/// All of them, in the order in which they act in a stage: gravity first.
const EffectKinds& effect_kinds();

/// How the scene's scheme takes explicit terms, so that a steady flow does not depend on the step where the scheme allows it: with fluxes,
/// from the fields of before each (sub)step; along paths to second order (MacCormack), half where they begin and half where they end;
/// along paths to first order, where they end.
inline Scheme scheme_of(const scene::Scene& scene) { return AdvectionOptions(scene.root().table("scheme")).scheme; }

EffectKind buoyancy();
EffectKind confinement();
EffectKind diffusion();
EffectKind cooling();
EffectKind decay();
EffectKind viscosity();

}  // namespace weir::flow
