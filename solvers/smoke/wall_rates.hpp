// Terms of solid walls in the diffusion of a velocity component. A wall's conductance c = 1/(θ h²) is unbounded as θ falls. The part up to
// that of a domain wall, m = min(c, 2/h²), uses the time scheme of regular neighbours; c − m is implicit.
#pragma once
#include "mac/bodies/solid_walls.hpp"
#include "smoke/helmholtz.hpp"

namespace weir::smoke {

/// Weights of the Laplacian's parts in a time scheme.
struct WallShares {
    real early;      // of m, from the previous velocities, ½ for Crank-Nicolson
    bool has_early;  // whether that part is still to be added
    real before;     // of the previous Laplacian on the right-hand side
    real implicit;   // of the Laplacian of the correction
};

/// rate += the change of ∇²q by walls where it is explicit: m (u_wall − q) instead of (q(N) − q(I))/h².
template <int D>
void add_wall_rates(const MacState<D>& s, int a, const Padded<D>& q, Grid<real, D>& rate);
/// u ← (u + a Σ (c − m) u_wall)/(1 + a Σ (c − m)): the implicit part after an explicit step.
template <int D>
void pull_to_walls(const MacState<D>& s, int a, real dt_nu, Grid<real, D>& u);
/// As add_wall_rates, for the right-hand side of an implicit solve, with walls at their final positions; and the rows of the solve.
template <int D>
void set_wall_rows(const MacState<D>& s, int a, const WallShares& shares, real dt_nu, const Padded<D>& before, Grid<real, D>& rate,
                   WallRows<D>& rows);

}  // namespace weir::smoke
