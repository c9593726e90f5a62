// What makes a lattice of samples fit to be contoured: the surface then is closed and has no slivers.
#pragma once
#include "geometry/solids.hpp"
#include "reconstruction/samples.hpp"

namespace weir::reconstruction {

/// No liquid beyond the sides of a box, of which a lattice has at most its outermost samples: where there is liquid at a side, the surface
/// is the side. Nor in solids.
void keep_inside(Samples& samples, const Vec<3>& lo, const Vec<3>& hi);
template <int D>
void keep_out_of(Samples& samples, const geometry::Solids<D>& solids);
/// Moves values that are nearly zero away from it: the surface then passes no sample closer than 2e-3 of the way to the next one, so that
/// its smallest triangle, across a corner, has at least 0.866 (2e-3)^2 of a cell's face. The ends of the lattice are outside; those of a
/// plane of samples are its edges.
void avoid_zero(Samples& samples);

}  // namespace weir::reconstruction
