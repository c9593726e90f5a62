// Integrals and derived fields of a MAC state, for reports.
#pragma once
#include "core/solver.hpp"
#include "mac/grid/state.hpp"

namespace weir::mac {

/// ½ ρ Σ u² over the open part of each face's volume (half a volume on closed sides) [J; per metre of depth in 2D].
template <int D>
real kinetic_energy(const MacState<D>& s);
/// ρ Σ u over the open part of each face's volume [kg m/s].
template <int D>
Vec<D> momentum(const MacState<D>& s);
/// ½ Σ |ω|² over the edges inside the domain (periodic ones included), each with a cell's volume [m^D/s²].
template <int D>
real enstrophy(const MacState<D>& s);
/// Σ q over fluid cells, times the cell's volume.
template <int D>
real integral(const MacState<D>& s, const Grid<real, D>& q);

/// kinetic_energy, enstrophy, max_speed, max_divergence, momentum_x .., total_<field> for each advected field.
template <int D>
std::vector<Integral> integrals(const MacState<D>& s);

/// Vorticity at cell centres [1/s]: one component in 2D, three in 3D; one-sided at the sides of the domain.
template <int D>
void vorticity(const MacState<D>& s, const Extent<D>& cells, std::vector<Grid<real, D>>& omega);

template <int D>
GridView grid_view(const MacVelocity<D>& u);
/// velocity, pressure, and the advected fields.
template <int D>
FieldSet field_set(const MacState<D>& s);

}  // namespace weir::mac
