// Which liquid of a scene begins at rest: bodies of particles under a flat top, on walls or solids below and beside. Its pressure begins as
// that of its weight, where a column that begins without any falls onto its own sound waves and rings.
#pragma once
#include "particles/fluid.hpp"

#include <string>

namespace weir::sph {

/// Raises `carried` of particles at rest to rho g times their depth [Pa]. Answers what a user should know of liquid that stands in a vessel
/// and has no flat top; empty where there is none. Over ranks all call it together.
template <int D>
std::string start_at_rest(particles::Fluid<D>& fluid);

}  // namespace weir::sph
