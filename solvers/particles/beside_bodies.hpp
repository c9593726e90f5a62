// Where particles stand at the start beside bodies: as many as the volume has room for that bodies leave of the lattice's cells, so that
// the water stands as high beside them as the scene says. Which cells' middles a body covers would be wrong by a row of them under a flat
// bottom.
#pragma once
#include "particles/domain.hpp"

#include <vector>

namespace weir::particles {

/// Signed distance to the nearest body [m].
template <int D>
real away_from_bodies(const Domain<D>& domain, const Vec<D>& x);
/// Of the middles of wet cells that bodies may cut: those to be kept, put out of the bodies.
template <int D>
std::vector<Vec<D>> places_beside_bodies(const Domain<D>& domain, const std::vector<Vec<D>>& middles);

}  // namespace weir::particles
