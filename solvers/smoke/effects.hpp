// The effects of the solver "mac" by name, each in a file of its own.
#pragma once
#include "mac/advection/advection.hpp"
#include "mac/grid/effects.hpp"

namespace weir::smoke {

using namespace mac;  // the grid's words are the solver's own

/// Its step runs all stages.
inline const std::vector<Stage> all_stages{Stage::source, Stage::force, Stage::carried, Stage::implicit, Stage::finish};

/// All of them, in the order in which they act in a stage: gravity first.
const EffectKinds& effect_kinds();

/// Where the scene's scheme applies explicit terms; steady flows then do not depend on the step where the scheme allows it. Flux form: from
/// the fields before each (sub)step. Second-order semi-Lagrangian (MacCormack): half at the departure point, half at the arrival point.
/// First-order semi-Lagrangian: at the arrival point.
inline Scheme scheme_of(const scene::Scene& scene) { return AdvectionOptions(scene.root().table("scheme")).scheme; }

EffectKind buoyancy();
EffectKind confinement();
EffectKind diffusion();
EffectKind cooling();
EffectKind decay();
EffectKind viscosity();

}  // namespace weir::smoke
