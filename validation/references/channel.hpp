// Flow between plates that starts from rest: exact series (Batchelor 1967, sec. 4.3; both are Fourier solutions of u_t = G + nu u_yy).
#pragma once
#include "core/types.hpp"

namespace weir::validation {

/// u(y, t) [m/s] between plates at rest at y = 0 and H, driven by G = -dp/dx / rho [m/s^2] from t = 0:
/// u = G y (H - y) / (2 nu) - sum_n 4G / (nu H k_n^3) sin(k_n y) exp(-nu k_n^2 t),  k_n = (2n + 1) pi / H.
real poiseuille_startup(real y, real t, real H, real G, real nu);

/// u(y, t) [m/s] where the plate y = H moves with U from t = 0 and y = 0 rests:
/// u = U y/H + sum_n 2U/(n pi) (-1)^n sin(n pi y/H) exp(-nu (n pi/H)^2 t).
real couette_startup(real y, real t, real H, real U, real nu);

}  // namespace weir::validation
