// Initial particles beside bodies: their number matches the volume that bodies leave open in the lattice's cells, so that the liquid has
// the prescribed height beside them. Selecting cells by their centres would be wrong by a whole row under a flat bottom.
#pragma once
#include "particles/state/domain.hpp"

#include <vector>

namespace weir::particles {

/// Signed distance to the nearest body [m].
template <int D>
real away_from_bodies(const Domain<D>& domain, const Vec<D>& x);
/// Selects, from the centres of wet cells that bodies may cut, the particles to create, and moves them out of the bodies.
template <int D>
std::vector<Vec<D>> places_beside_bodies(const Domain<D>& domain, const std::vector<Vec<D>>& middles);

}  // namespace weir::particles
