// Dx/Dt = u: markers advected by the face velocity with Runge–Kutta steps (RK2: midpoint; RK3: Ralston 1962, as Bridson 2015 advises), kept
// outside solids and inside the domain.
#pragma once
#include "free_surface/markers.hpp"
#include "mac/bodies/solid_faces.hpp"

#include <cstdint>

namespace weir::free_surface {

enum class Trace { rk1, rk2, rk3 };

/// The position of a point after dt (which may be negative: a backward trace) in the steady field u.
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

/// Minimum distances of markers from walls and solids [cells]: small, but larger than round-off of a position.
inline constexpr real wall_margin = 1e-3;

/// Flags of cells so close to a solid that markers there must be checked (within SolidPlacement::reach(), or inside): 0 none, k + 2 near
/// solid k alone, 1 near several (or one whose number exceeds a byte).
template <int D>
void mark_near_solids(const SolidPlacement<D>& placement, const Frame<D>& frame, Grid<std::uint8_t, D>& near_solid);

/// Moves all markers by dt. Beyond open sides they leave the domain (see left_domain), at walls and solids they stop. near_solid is empty
/// where there are no solids. Markers must be sorted; afterwards they are not.
template <int D>
void move_markers(Markers<D>& markers, const MacVelocity<D>& u, const Frame<D>& frame, real dt, Trace order,
                  const geometry::Sides<D>& sides, const geometry::Solids<D>& solids, const Grid<std::uint8_t, D>& near_solid);

/// Removes the markers beyond an open side; returns their number.
template <int D>
std::size_t remove_departed(Markers<D>& markers, const Frame<D>& frame, const geometry::Sides<D>& sides);

}  // namespace weir::free_surface
