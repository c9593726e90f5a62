// Pressure on a wall. On grids: a weighted linear least-squares fit (moving least squares, Lancaster & Salkauskas 1981) to adjacent cell
// centres, evaluated at the wall; samples in air or inside a solid are excluded. For particles: their force on the wall per area.
#pragma once
#include "core/solver.hpp"
#include "geometry/solids.hpp"

namespace weir::sim {

/// At the point of the domain's sides and the solids closest to `at` [Pa]; 0, the pressure of the air, where no liquid touches it. On
/// grids: exact for a linear pressure where the samples beside the wall are not coplanar; with a single layer the result is the pressure of
/// that layer. For particles: exact for liquid at rest on its initial lattice, two spacings below its surface.
template <int D>
real wall_pressure(const FieldSet& fields, const geometry::Solids<D>& solids, const Vec<D>& at);

}  // namespace weir::sim
