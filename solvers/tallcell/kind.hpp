// The schema of the solver "tallcell".
#pragma once
#include "mac/grid/effects.hpp"

namespace weir::tallcell {

using namespace mac;

/// Forces on the bulk of the liquid, applied between momentum and pressure.
const EffectKinds& body_forces();

}  // namespace weir::tallcell
