// Procedural waves, as mathematics without a solver: steady trains to the fifth order (Fenton 1985), Gerstner's trochoid, the height of
// wind seas, and a wave that comes over a slope.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <functional>

namespace weir::validation {

/// Fenton's wave of height H: kd and e = kH/2 say everything. Orders below 5 leave out the higher powers of e.
struct FentonWave {
    real k, depth, speed;
    std::array<real, 5> eta, u;  // eta = sum eta_j cos(j theta); u = sum u_j cosh(j k (y + d))/cosh(j k d) cos(j theta)
};
FentonWave fenton(real g, real depth, real height, real wavelength, int order);

/// Height of Gerstner's surface over x, by bisection of x = a - sin(k a - w t)/k ka, and its velocity and that of the water below.
struct Trochoid {
    real k, omega, amplitude;
    real rest(real x, real y, real t, real& depth) const;  // where the particle at (x, y) rests: returns x0, sets y0
    real height(real x, real t) const;
    Vec<3> velocity(real x, real y, real t) const;
};

/// Variance of a sea between two frequencies [m^2], as the scene's table waves.spectrum says; by GSL's adaptive quadrature.
real sea_variance(const scene::Scene& scene, real from, real to);

}  // namespace weir::validation
