// What a scene may say to the solver "tallcell".
#pragma once
#include "staggered/effects.hpp"

namespace weir::tallcell {

using namespace staggered;

/// Forces on the liquid's bulk, which act between momentum and pressure.
const EffectKinds& body_forces();

}  // namespace weir::tallcell
