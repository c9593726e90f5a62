// Decaying vortices (Taylor & Green 1937), an exact solution of the Navier-Stokes equations in 2D:
//   u = U sin(kx) cos(ky) F,  v = -U cos(kx) sin(ky) F,  p = rho U^2/4 (cos 2kx + cos 2ky) F^2,  F = exp(-2 nu k^2 t).
// It also slides along x = 0, pi/k and y = 0, pi/k: usable in a closed box with free slip.
#pragma once
#include "core/types.hpp"

namespace weir::validation {

struct TaylorGreen {
    real U = 1, k = 1, nu = 0, rho = 1;
    real F(real t) const { return std::exp(-2 * nu * k * k * t); }
    Vec<2> velocity(const Vec<2>& x, real t) const {
        return U * F(t) * Vec<2>{std::sin(k * x[0]) * std::cos(k * x[1]), -std::cos(k * x[0]) * std::sin(k * x[1])};
    }
    real pressure(const Vec<2>& x, real t) const {
        return rho * U * U / 4 * (std::cos(2 * k * x[0]) + std::cos(2 * k * x[1])) * F(t) * F(t);
    }
    /// Mean over a period of |u|^2 / 2 [m^2/s^2].
    real energy(real t) const { return U * U / 4 * F(t) * F(t); }
    /// Mean over a period of omega^2 / 2 [1/s^2]; dE/dt = -2 nu times it.
    real enstrophy(real t) const { return U * U * k * k / 2 * F(t) * F(t); }
};

}  // namespace weir::validation
