// The stage of rows.hpp in the papers' form, face by face, without caching: the reference for the fast one.
#pragma once
#include "heightfield/rows.hpp"

namespace weir::heightfield {

/// to = from + dt L(from), or for the second stage (to + from + dt L(from)) / 2.
void reference_stage(const StageOf& stage, Limiter limiter);

}  // namespace weir::heightfield
