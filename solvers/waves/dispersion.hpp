// Dispersion of small waves (Lamb 1932, sec. 228 and 267), and their decay with depth (Airy):
//
//     omega^2 = (g k + sigma k^3 / rho) tanh(k d),        u ~ cosh k(y + d) / sinh k d
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <complex>

namespace weir::waves {

/// The restoring forces of waves; zero unless a scene names them.
struct Restoring {
    real g = 0;               // downwards [m/s^2]
    real sigma_over_rho = 0;  // surface tension over density [m^3/s^2]
    bool acts() const { return g > 0 || sigma_over_rho > 0; }
};

/// omega(k) at a depth [1/s]; infinite depth: deep water.
real frequency(const Restoring& by, real k, real depth);
/// d omega / d k, the group speed [m/s].
real group_speed(const Restoring& by, real k, real depth);
/// The k with this frequency: omega(k) is increasing and unbounded, so it exists. To round-off (Newton within a bracket).
real wavenumber(const Restoring& by, real omega, real depth);

/// cosh k(y + d) / sinh k d and sinh k(y + d) / sinh k d without overflow: in deep water both are exp(k y). Above the mean level, where
/// linear theory is undefined, the values at the level are used.
struct Reach {
    real along, up;
};
inline Reach reach(real k, real y, real depth) {
    const real below = std::min(y, 0.0), down = std::exp(k * below);
    if (depth == infinity) return {down, down};
    const real image = std::exp(-2 * k * (std::max(below, -depth) + depth)), closed = -std::expm1(-2 * k * depth);
    return {down * (1 + image) / closed, down * (1 - image) / closed};
}

/// Height over wavelength beyond which no steady wave exists (Miche 1944); in deep water Stokes's 0.142, where the crest is a corner of 120
/// degrees (Michell 1893: 0.1418; later values down to 0.1412).
inline real steepest(real k, real depth) { return 0.142 * std::tanh(k * depth); }

}  // namespace weir::waves
