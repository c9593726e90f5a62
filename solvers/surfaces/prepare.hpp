// Prepares a lattice of samples for contouring: the surface is then closed and without slivers.
#pragma once
#include "geometry/solids.hpp"
#include "surfaces/samples.hpp"

namespace weir::surfaces {

/// Removes liquid beyond the sides of a box, which contain at most the outermost samples: liquid at a side gets the side as its surface.
/// Also removes it inside solids.
void keep_inside(Samples& samples, const Vec<3>& lo, const Vec<3>& hi);
template <int D>
void keep_out_of(Samples& samples, const geometry::Solids<D>& solids);
/// Moves values close to zero away from it: the distance of the surface from any sample is then at least 2e-3 of the sample spacing, so its
/// smallest triangle, across a corner, has at least 0.866 (2e-3)^2 of a cell's face. The ends of the lattice are outside; for a plane of
/// samples these are its edges.
void avoid_zero(Samples& samples);

}  // namespace weir::surfaces
