// The speed of sound of a scene that names none: ten times the fastest flow that can be told before the start, so that density stays
// within one per cent (Monaghan 1994, section 3).
#pragma once
#include "particles/fluid.hpp"

namespace weir::sph {

/// The fastest flow [m/s] that a scene gives rise to by itself: what falls from the highest liquid (or emitter) to the lowest corner of
/// the domain, the central force's drop, the initial velocities, and the speeds of emitters, walls and solids. 0: nothing tells.
template <int D>
real fastest_flow(const scene::Scene& scene, particles::Fluid<D>& fluid);

}  // namespace weir::sph
