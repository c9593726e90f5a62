// Curvature of the surface, κ = ∇·n, n outwards: of the parabola (paraboloid in 3D) that fits the places where the surface crosses the
// lines of the grid near a cell (Renardy & Renardy 2002; Popinet 2009, sec. 2.4.3). Those depend on φ in the cells beside the surface
// alone, where motion keeps it smooth; second differences of φ look at cells further away, whose distances are of first order.
#pragma once
#include "surface/level_set.hpp"

namespace weir::water {

using namespace surface;  // the words of the grid and of its free surface are the solver's own

/// [1/m] at the place of the surface that is next to the centre of cell I, which must be beside it.
template <int D>
real curvature_near(const Grid<real, D>& phi, const Frame<D>& frame, const Index<D>& I);

}  // namespace weir::water
