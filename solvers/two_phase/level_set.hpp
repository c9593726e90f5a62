// The signed distance to the interface, for drawing and probes: the distance to the planes of cells within two cells, in physical space.
#pragma once
#include "two_phase/curvature.hpp"

namespace weir::two_phase {

/// Distances [m], negative in the liquid, cut off at two cells.
template <int D>
void find_distance(const Interface<D>& interface, Grid<real, D>& phi);

}  // namespace weir::two_phase
