// Drops of an inviscid incompressible liquid whose velocity stays linear in the coordinates: (-A x, A y). Monaghan 1994 (J. Comput. Phys.
// 110, 399) without a field, Monaghan & Rafiee 2013 in the field -Omega^2 r. And the pressure in a square that starts to rotate.
#pragma once
#include "core/types.hpp"

namespace weir::validation {

/// Semi-axes along x and y, and the rate of strain.
struct Ellipse {
    real a = 1, b = 1, A = 0;
};
/// a' = -a A, b' = b A, A' = (A^2 + Omega^2) (a^2 - b^2) / (a^2 + b^2), by Runge and Kutta's fourth-order method in `steps` steps.
Ellipse stretched(const Ellipse& start, real Omega, real t, int steps = 4000);

/// Pressure over rho omega^2 L^2 at (x, y) / L from the centre of a square patch that rotates rigidly with p = 0 on its sides:
/// -sum over odd m, n of 32 / (m n pi^2 [(m pi)^2 + (n pi)^2]) sin(m pi (x + 1/2)) sin(n pi (y + 1/2)).
real rotating_patch_pressure(real x, real y);

}  // namespace weir::validation
