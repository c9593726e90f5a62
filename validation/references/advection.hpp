// Shapes and flows of the advection tests, as level sets (signed distance, negative inside) on the unit square.
// Zalesak 1979 (J. Comput. Phys. 31, 335); single vortex: LeVeque 1996, Rider & Kothe 1998; set-ups as in the baseline tables.
#pragma once
#include "core/types.hpp"

namespace weir::validation {

/// Disk of radius 0.15 about (0.5, 0.75) with a slot 0.05 wide, open below, whose top is at y = 0.85. Exact signed distance.
real slotted_disk(const Vec<2>& x);
/// The disk of the single vortex: radius 0.15 about (0.5, 0.75).
real vortex_disk(const Vec<2>& x);
/// exp(-|x - (0.5, 0.75)|^2 / 0.08^2).
real gaussian_hill(const Vec<2>& x);

/// u = 2 pi (0.5 - y, x - 0.5): one turn a second, anticlockwise about (0.5, 0.5).
Vec<2> rigid_rotation(const Vec<2>& x);
/// u = (-2 sin^2(pi x) sin(pi y) cos(pi y), 2 sin^2(pi y) sin(pi x) cos(pi x)) cos(pi t / T): back where it was at t = T.
Vec<2> single_vortex(const Vec<2>& x, real t, real T);
/// x turned back by `turns` about (0.5, 0.5): where the fluid now at x came from.
Vec<2> unturned(const Vec<2>& x, real turns);

/// Exact areas of the two shapes.
real slotted_disk_area();
real vortex_disk_area();

}  // namespace weir::validation
