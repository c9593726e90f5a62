// Estimate of the maximum speed of a scene before it starts. SPH derives its speed of sound from it (ten times the speed keeps density
// within one per cent, Monaghan 1994, section 3), PBF its step.
#pragma once
#include "particles/state/fluid.hpp"

namespace weir::particles {

/// The maximum of: free fall from the highest liquid (or emitter) to the lowest corner of the domain, the drop in the central force, the
/// initial velocities, and the speeds of emitters, walls and solids [m/s]. 0: no estimate.
template <int D>
real fastest_flow(const scene::Scene& scene, Fluid<D>& fluid);

}  // namespace weir::particles
