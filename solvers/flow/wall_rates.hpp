// What walls of solids add to the diffusion of a velocity component. A wall's conductance c = 1/(θ h²) has no bound as θ falls: as much of
// it as a wall of the domain has, m = min(c, 2/h²), is treated in time as the grid's neighbours are, and c − m is implicit.
#pragma once
#include "flow/helmholtz.hpp"
#include "staggered/solid_walls.hpp"

namespace weir::flow {

/// How a scheme in time divides the Laplacian of a step.
struct WallShares {
    real early;      // of m, from the velocities of before the step, ½ with Crank-Nicolson
    bool has_early;  // whether that is still to be added
    real before;     // of the Laplacian of before on the right-hand side
    real implicit;   // of the Laplacian of the correction
};

/// rate += what walls change of ∇²q where all of it is explicit: m (u_wall − q) for (q(N) − q(I))/h².
template <int D>
void add_wall_rates(const MacState<D>& s, int a, const Padded<D>& q, Grid<real, D>& rate);
/// u ← (u + a Σ (c − m) u_wall)/(1 + a Σ (c − m)): what an explicit step leaves of them.
template <int D>
void pull_to_walls(const MacState<D>& s, int a, real dt_nu, Grid<real, D>& u);
/// The same as add_wall_rates for the right-hand side of an implicit solve, whose walls move to where they end; and the solve's rows.
template <int D>
void set_wall_rows(const MacState<D>& s, int a, const WallShares& shares, real dt_nu, const Padded<D>& before, Grid<real, D>& rate,
                   WallRows<D>& rows);

}  // namespace weir::flow
