// The choices of a PBF scene ("scheme" and two effects), and the numbers that the pair physics reads, made from them.
#pragma once
#include "backend/device.hpp"
#include "particles/fluid.hpp"
#include "particles/kernels.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::pbf {

/// A method's pair of kernels: one for the density, one for its gradient.
enum class Smoothing { muller, cubic, wendland };

struct Options {
    Smoothing smoothing = Smoothing::cubic;
    real support = 2;    // over the spacing
    int iterations = 4;  // fixed, where tolerance is 0
    real tolerance = 0;  // mean compression at which the iterations end
    int max_iterations = 100;
    real cfm = 1e-4;        // epsilon of eq. 11, in units of 1 / support^2
    real relaxation = 0.6;  // Jacobi over all pairs overshoots: on a lattice its largest eigenvalue is 2.15 (2D), 2.82 (3D), limit 2 / 2.82
    real warm_start = 0.4;  // part of the last step's multipliers that the iterations start from; from 0.5 on rest is unstable (ADR 10)
    int settle = 300;       // at most so many iterations that take the initial density error out of the positions
    real pressure_k = 0;    // artificial pressure (eq. 13): k in units of support^2, 0: none
    real pressure_dq = 0.2;  // delta q over the support
    backend::Choice backend;

    Options() = default;
    explicit Options(const scene::Scene& scene);
};

/// As far as the fastest flow of the scene goes in `cfl` spacings, and a whole number of steps from frame to frame: what a step leaves of
/// compression goes with dt^2, and a step that is shorter than the last would turn the difference into speed. So it never changes.
template <int D>
real even_step(const scene::Scene& scene, particles::Fluid<D>& fluid);

/// A particle that crosses its support in a step passes those that should have stopped it before a correction sees them.
template <int D>
StepLimit stable_step(const Options& options, const particles::Fluid<D>& fluid, real speed);

/// What a scene is told whose walls are stuck to.
inline constexpr const char* instead_of_sticking = "PBF has none: take slip = \"free\", or solver = \"sph\" with its viscosity";

/// Of the iterations that settle the first state: after so many a particle may have got new neighbours, and a compression of the densest
/// particle of a tenth of what a step leaves is good enough.
inline constexpr int settle_between_lists = 5;
inline constexpr real settle_good_enough = 1e-3;

template <int D>
particles::Kernel<D> density_kernel(const Options& options, real spacing);
template <int D>
particles::Kernel<D> gradient_kernel(const Options& options, real spacing);

/// Params is particles::single::PbfParams or particles::plain::PbfParams.
template <class Params, int D>
Params pbf_params(const Options& options, real spacing);

}  // namespace weir::pbf
