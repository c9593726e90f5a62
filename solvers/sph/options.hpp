// The choices of an SPH scene, and the numbers that the pair physics reads, made from them.
#pragma once
#include "particles/kernels.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::sph {

enum class Smoothing { muller, cubic, wendland };

struct Options {
    Smoothing smoothing = Smoothing::muller;
    real support = 2;      // over the spacing
    real sound = 10;       // speed of sound [m/s]
    real gamma = 1;        // 1: the linear equation of state of Müller et al.; else Tait's
    bool tension = false;  // whether pressure may be negative
    std::string isa = "auto";
    real viscosity = 0;   // kinematic, acts only where the effect is named [m^2/s]
    real artificial = 0;  // alpha

    Options() = default;
    explicit Options(const scene::Scene& scene);
    /// p = c^2 (rho - rho0), or B ((rho / rho0)^gamma - 1) with B = c^2 rho0 / gamma (Monaghan 1994).
    real pressure(real rho, real rho0) const;
};

template <int D>
particles::Kernel<D> density_kernel(const Options& options, real spacing);
template <int D>
particles::Kernel<D> gradient_kernel(const Options& options, real spacing);

/// Params is particles::single::SphParams or particles::plain::SphParams.
template <class Params, int D>
Params sph_params(const Options& options, real spacing, real rho0);

}  // namespace weir::sph
