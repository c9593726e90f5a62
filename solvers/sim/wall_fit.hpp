// Pressure on a wall. On grids: the weighted linear least-squares fit (moving least squares, Lancaster & Salkauskas 1981) to the centres of
// cells beside it, taken at the wall; samples in the air or inside a solid take no part. Of particles: their force on the wall per area.
#pragma once
#include "core/solver.hpp"
#include "geometry/solids.hpp"

namespace weir::sim {

/// At the point nearest to `at` of the domain's sides and the solids [Pa]; 0, the pressure of the air, where no liquid touches it. On
/// grids exact for a linear pressure where the samples beside the wall do not lie in one plane; along a single layer of them the pressure
/// at the wall is that of the layer. Of particles exact for liquid at rest on the lattice that it begins on, two spacings below its
/// surface.
template <int D>
real wall_pressure(const FieldSet& fields, const geometry::Solids<D>& solids, const Vec<D>& at);

}  // namespace weir::sim
