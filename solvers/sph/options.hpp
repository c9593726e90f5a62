// The choices of an SPH scene, and the numbers that the pair physics reads, made from them.
#pragma once
#include "geometry/sides.hpp"
#include "particles/scheme.hpp"

namespace weir::sph {

/// The constants of delta-SPH: diffusion of density and artificial viscosity (Marrone et al. 2011, section 2).
struct DeltaSph {
    real diffusion = 0.1, viscosity = 0.02;
};
inline constexpr DeltaSph delta_sph{};

struct Options : particles::Scheme {
    real sound = 10;          // speed of sound [m/s]
    real gamma = 1;           // 1: the linear equation of state of Müller et al.; else Tait's
    bool tension = false;     // whether pressure may be negative
    bool continuity = false;  // density by its rate, not by a sum
    real viscosity = 0;       // kinematic, acts only where the effect is named [m^2/s]
    real artificial = 0;      // alpha
    real diffusion = 0;       // delta of the density's diffusion
    real sigma = 0;           // surface tension [N/m]
    std::array<real, 3> gravity{0, 0, 0};
    std::array<real, 6> stick{};   // 2 nu at the sides where the fluid sticks to a wall: x lo, x hi, y lo, ...
    std::array<real, 18> slide{};  // and the velocities of these walls

    Options() : Scheme{particles::Smoothing::wendland, 4} {}
    /// fastest: the fastest flow that the scene tells [m/s] (particles/fastest_flow.hpp). Where no speed of sound is named, it is ten times
    /// that, or 10 m/s where there is none.
    Options(const scene::Scene& scene, real fastest);
    /// p = c^2 (rho - rho0), or B ((rho / rho0)^gamma - 1) with B = c^2 rho0 / gamma (Monaghan 1994).
    real pressure(real rho, real rho0) const;
    /// The density that has this pressure.
    real density(real pressure, real rho0) const;
    /// What compression from rho0 to rho stores: the integral of p / rho^2 over rho [J/kg].
    real elastic_energy(real rho, real rho0) const;
    /// Whether walls add to the forces more than a particle's own pressure.
    bool wall_forces() const;

private:
    template <int D>
    void read_sides(const scene::Scene& scene);
};

/// Params is particles::single::SphParams or particles::plain::SphParams.
template <class Params, int D>
Params sph_params(const Options& options, real spacing, real rho0);

}  // namespace weir::sph
