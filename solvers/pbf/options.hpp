// The choices of a PBF scene ("scheme" and two effects), and the numbers that the pair physics reads, made from them.
#pragma once
#include "core/solver.hpp"
#include "particles/fluid.hpp"
#include "particles/scheme.hpp"

namespace weir::pbf {

struct Options : particles::Scheme {
    int iterations = 4;  // fixed, where tolerance is 0
    real tolerance = 0;  // mean compression at which the iterations end
    int max_iterations = 100;
    real cfm = 1e-4;        // epsilon of eq. 11, in units of 1 / support^2
    real relaxation = 0.6;  // Jacobi over all pairs overshoots: on a lattice its largest eigenvalue is 2.15 (2D), 2.82 (3D), limit 2 / 2.82
    real warm_start = 0.4;  // part of the last step's multipliers that the iterations start from; from 0.5 on rest is unstable (ADR 10)
    int settle = 300;       // at most so many iterations that take the initial density error out of the positions
    real pressure_k = 0;    // artificial pressure (eq. 13): k in units of support^2, 0: none
    real pressure_dq = 0.2;  // delta q over the support

    Options() : Scheme{particles::Smoothing::cubic, 2} {}
    explicit Options(const scene::Scene& scene);

private:
    void check_vapour(const scene::Scene& scene) const;
};

/// The step [s]: as far as the fastest flow of the scene goes in `cfl` spacings; with output.at = "exact" a whole number of them from frame
/// to frame. What a step leaves of compression goes with dt^2, and a shorter step would turn the difference into speed: it never changes.
template <int D>
real even_step(const scene::Scene& scene, particles::Fluid<D>& fluid);

/// How much of what a wall gives a particle in one iteration it takes off again where the wall gives way by one: the part of a multiplier's
/// denominator that a particle beside a wall has, half of the lattice's, relaxed [m^2].
template <int D>
real give_at_walls(const Options& options, real spacing);

/// A particle that crosses its support in a step passes those that should have stopped it before a correction sees them.
template <int D>
StepLimit stable_step(const Options& options, const particles::Fluid<D>& fluid, real speed);

/// The scene's liquid at the start. Throws BadScene where walls are stuck to.
template <int D>
particles::Fluid<D> first_fluid(const scene::Scene& scene);

/// Params is particles::single::PbfParams or particles::plain::PbfParams.
template <class Params, int D>
Params pbf_params(const Options& options, real spacing);

}  // namespace weir::pbf
