// The options of an SPH scene, and the parameters of the pair physics derived from them.
#pragma once
#include "geometry/sides.hpp"
#include "particles/state/scheme.hpp"

namespace weir::sph {

/// The constants of delta-SPH: diffusion of density and artificial viscosity (Marrone et al. 2011, section 2).
struct DeltaSph {
    real diffusion = 0.1, viscosity = 0.02;
};
inline constexpr DeltaSph delta_sph{};

struct Options : particles::Scheme {
    real sound = 10;          // speed of sound [m/s]
    real gamma = 1;           // 1: the linear equation of state of Müller et al.; otherwise Tait's
    bool tension = false;     // whether pressure may be negative
    bool continuity = false;  // density by the continuity equation instead of summation
    real viscosity = 0;       // kinematic; only with the effect [m^2/s]
    real artificial = 0;      // alpha
    real diffusion = 0;       // delta of the density diffusion
    real sigma = 0;           // surface tension [N/m]
    std::array<real, 3> gravity{0, 0, 0};
    std::array<real, 6> stick{};   // 2 nu at no-slip sides: x lo, x hi, y lo, ...
    std::array<real, 18> slide{};  // velocities of these walls

    Options() : Scheme{particles::Smoothing::wendland, 4} {}
    /// fastest: the estimated maximum speed of the scene [m/s] (particles/state/fastest_flow.hpp). The default speed of sound is ten times
    /// that, or 10 m/s where there is no estimate.
    Options(const scene::Scene& scene, real fastest);
    /// p = c^2 (rho - rho0), or B ((rho / rho0)^gamma - 1) with B = c^2 rho0 / gamma (Monaghan 1994).
    real pressure(real rho, real rho0) const;
    /// Inverse of pressure().
    real density(real pressure, real rho0) const;
    /// Elastic energy of compression from rho0 to rho: the integral of p / rho^2 over rho [J/kg].
    real elastic_energy(real rho, real rho0) const;
    /// Returns whether walls exert forces besides a particle's own pressure.
    bool wall_forces() const;

private:
    template <int D>
    void read_sides(const scene::Scene& scene);
};

/// Params is particles::single::SphParams or particles::plain::SphParams.
template <class Params, int D>
Params sph_params(const Options& options, real spacing, real rho0);

}  // namespace weir::sph
