// Finds the liquid of a scene that starts at rest: sets of particles with a flat top, supported by walls or solids below and beside. Its
// initial pressure is hydrostatic; a column that starts without pressure would fall and oscillate acoustically.
#pragma once
#include "particles/state/fluid.hpp"

#include <string>

namespace weir::sph {

/// Sets `carried` of particles at rest to rho g times their depth [Pa]. Returns a warning about liquid in a vessel without a flat top;
/// otherwise empty. In parallel the call is collective.
template <int D>
std::string start_at_rest(particles::Fluid<D>& fluid);

}  // namespace weir::sph
