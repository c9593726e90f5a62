// Curvature of the surface, κ = ∇·n, n outwards: of the parabola (paraboloid in 3D) fitted to the crossings of the surface with grid lines
// near a cell (Renardy & Renardy 2002; Popinet 2009, sec. 2.4.3). The crossings depend only on φ in cells beside the surface, where
// advection keeps it smooth. Second differences of φ would read cells further away, whose distances are first-order accurate.
#pragma once
#include "free_surface/level_set.hpp"

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

/// [1/m] at the surface point closest to the centre of cell I, which must be beside the surface.
template <int D>
real curvature_near(const Grid<real, D>& phi, const Frame<D>& frame, const Index<D>& I);

}  // namespace weir::water
