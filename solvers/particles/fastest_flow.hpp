// The fastest flow that can be told from a scene before it starts: SPH takes its speed of sound from it (ten times it keeps density within
// one per cent, Monaghan 1994, section 3), PBF its step.
#pragma once
#include "particles/fluid.hpp"

namespace weir::particles {

/// What falls from the highest liquid (or emitter) to the lowest corner of the domain, the central force's drop, the initial velocities,
/// and the speeds of emitters, walls and solids [m/s]. 0: nothing tells.
template <int D>
real fastest_flow(const scene::Scene& scene, Fluid<D>& fluid);

}  // namespace weir::particles
