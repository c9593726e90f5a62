// The stage of rows.hpp once more, as the papers write it: one face after the other, nothing kept. What the fast one is compared with.
#pragma once
#include "heightfield/rows.hpp"

namespace weir::heightfield {

/// to = from + dt L(from), or for the second stage (to + from + dt L(from)) / 2.
void reference_stage(const StageOf& stage, Limiter limiter);

}  // namespace weir::heightfield
