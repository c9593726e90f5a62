// Pressure on a wall, from the samples of the liquid beside it: the weighted linear least-squares fit (moving least squares, Lancaster &
// Salkauskas 1981), taken at the wall. Cell centres and particles alike; samples in the air or inside a solid take no part.
#pragma once
#include "core/solver.hpp"
#include "geometry/solids.hpp"

namespace weir::sim {

/// At the point nearest to `at` of the domain's sides and the solids [Pa]; 0, the pressure of the air, where no liquid touches it. Exact
/// for a linear pressure where the samples beside the wall do not lie in one plane; along a single layer of them the pressure at the wall
/// is that of the layer.
template <int D>
real wall_pressure(const FieldSet& fields, const geometry::Solids<D>& solids, const Vec<D>& at);

}  // namespace weir::sim
