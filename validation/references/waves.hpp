// Small waves on a free surface. Linear dispersion (Lamb 1932, sec. 228 and 267) and the viscous initial-value solution of
// Prosperetti 1981 (Phys. Fluids 24, 1217) for one fluid of infinite depth.
#pragma once
#include "core/types.hpp"

namespace weir::validation {

/// omega^2 = (g k + sigma k^3 / rho) tanh(k d)   [1/s^2 under the root]
real wave_frequency(real g, real k, real depth, real sigma_over_rho = 0);

/// Amplitude a(t) of a standing wave released at rest with amplitude a0 [m]:
///   a = 4 n^2 / (8 n^2 + w0^2) a0 erfc(sqrt(n t)) + sum_i z_i/Z_i w0^2 a0/(z_i^2 - n) exp((z_i^2 - n) t) erfc(z_i sqrt t),
/// n = nu k^2, z_i the roots of z^4 + 2 n z^2 + 4 n^(3/2) z + n^2 + w0^2 = 0, Z_i = prod_(j != i) (z_j - z_i).
/// With another fluid of the same viscosity above, beta = rho_1 rho_2/(rho_1 + rho_2)^2 (his equation 24):
///   z^4 - 4 beta n^(1/2) z^3 + 2 (1 - 6 beta) n z^2 + 4 (1 - 3 beta) n^(3/2) z + (1 - 4 beta) n^2 + w0^2 = 0,
/// and (1 - 4 beta) n^2 instead of n^2 in the first term of a.
real prosperetti(real t, real nu, real k, real omega0, real a0, real beta = 0);

/// Growth rate z^2 - n [1/s] of the real root z < 0 for w0^2 = omega2 < 0, where exp(z^2 t) erfc(z sqrt t) grows: the Rayleigh-Taylor
/// instability. 0: stable.
real growth_rate(real nu, real k, real omega2, real beta);

}  // namespace weir::validation
