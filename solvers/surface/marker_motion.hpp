// Dx/Dt = u: markers carried by the face velocity with Runge–Kutta steps (RK2: midpoint; RK3: Ralston 1962, as Bridson 2015 advises),
// kept out of solids and inside the domain.
#pragma once
#include "staggered/solid_faces.hpp"
#include "surface/markers.hpp"

#include <cstdint>

namespace weir::surface {

enum class Trace { rk1, rk2, rk3 };

/// Where a point is after dt (which may be negative: a trace back) in the steady field u.
template <int D>
Vec<D> trace(const MacVelocity<D>& u, const Frame<D>& frame, const Vec<D>& x, real dt, Trace order) {
    const auto velocity = [&](const Vec<D>& at) { return sample(u, Stencil<D>(frame, at)); };
    const Vec<D> k1 = velocity(x);
    if (order == Trace::rk1) return x + dt * k1;
    const Vec<D> k2 = velocity(x + (0.5 * dt) * k1);
    if (order == Trace::rk2) return x + dt * k2;
    const Vec<D> k3 = velocity(x + (0.75 * dt) * k2);
    return x + (dt / 9) * (2.0 * k1 + 3.0 * k2 + 4.0 * k3);
}

/// Distances that markers keep, in cells: from walls and from solids. Small, but more than round-off of a position.
inline constexpr real wall_margin = 1e-3;

/// Which cells are so near to a solid that a marker there must be checked, within one cell diagonal or inside: 0 none, k + 2 near solid k
/// alone, 1 near several (or one whose number a byte does not hold).
template <int D>
void mark_near_solids(const SolidPlacement<D>& placement, const Frame<D>& frame, Grid<std::uint8_t, D>& near_solid);

/// Moves all markers by dt. Beyond open sides they leave the domain (see left_domain), at walls and solids they stop.
/// near_solid is empty where there are no solids. Markers must be sorted; afterwards they are not.
template <int D>
void move_markers(Markers<D>& markers, const MacVelocity<D>& u, const Frame<D>& frame, real dt, Trace order,
                  const geometry::Sides<D>& sides, const geometry::Solids<D>& solids, const Grid<std::uint8_t, D>& near_solid);

/// Removes the markers that are beyond an open side; answers how many.
template <int D>
std::size_t remove_departed(Markers<D>& markers, const Frame<D>& frame, const geometry::Sides<D>& sides);

}  // namespace weir::surface
