// Inflow profiles by name: the inflow velocity at a point of a side.
#pragma once
#include "geometry/sides.hpp"
#include "mac/grid/velocity.hpp"

#include <string>
#include <vector>

namespace weir::mac {

const std::vector<std::string>& inflow_profiles();

/// u = 1 − e^(λx) cos 2πy,  v = (λ/2π) e^(λx) sin 2πy,  λ = Re/2 − √(Re²/4 + 4π²),  Re = 1/ν     Kovasznay 1948
template <int D>
Vec<D> kovasznay(const Vec<D>& x, real nu);

/// Velocity [m/s] of the inflow at x on a side. "uniform": the side's velocity; "parabolic": that velocity is the mean of 6 s (1 − s)
/// along each other axis that is not periodic; "kovasznay": see above, for unit speed and length.
template <int D>
Vec<D> inflow_velocity(const geometry::Sides<D>& sides, int axis, int end, const MacVelocity<D>& grid, const Vec<D>& x, real nu);

/// Sets the normal faces of walls (0 or the wall's own velocity) and inflows; they never change afterwards.
template <int D>
void set_side_faces(MacVelocity<D>& u, const geometry::Sides<D>& sides, real nu);

}  // namespace weir::mac
