// The effects of the solver "two_phase".
#pragma once
#include "mac/grid/effects.hpp"

#include <vector>

namespace weir::two_phase {

/// Forces per mass, which act on both phases alike.
const mac::EffectKinds& body_forces();
/// The schemas of all effects.
std::vector<scene::Variant> effect_schemas();

}  // namespace weir::two_phase
