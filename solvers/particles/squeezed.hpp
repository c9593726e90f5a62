// Liquid that solids squeeze: where the mean particle is compressed by a tenth there is no room left, and what goes on is no liquid.
#pragma once
#include "particles/fluid.hpp"

namespace weir::particles {

/// Throws NumericalFailure where solids move as the scene says and the mean compression is beyond a tenth: at Mach 0.3, where a liquid of
/// small compressibility ends, density differs by that much, and of incompressible liquid it is no error of a solve.
template <int D>
void require_room(const Fluid<D>& fluid, real mean_compression);

}  // namespace weir::particles
