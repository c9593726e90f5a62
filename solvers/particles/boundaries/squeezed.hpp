// Detects liquid compressed between solids: at a mean compression of a tenth there is no volume left for it, and the result is no longer a
// liquid.
#pragma once
#include "particles/state/fluid.hpp"

namespace weir::particles {

/// Throws NumericalFailure where solids have prescribed motion and the mean compression exceeds a tenth. Density differs by that much at
/// Mach 0.3, the limit of a weakly compressible liquid; in an incompressible method it is not a solver error.
template <int D>
void require_room(const Fluid<D>& fluid, real mean_compression);

}  // namespace weir::particles
