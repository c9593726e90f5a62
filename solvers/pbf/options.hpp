// The options of a PBF scene ("scheme" and two effects), and the parameters of the pair physics derived from them.
#pragma once
#include "core/solver.hpp"
#include "particles/state/fluid.hpp"
#include "particles/state/scheme.hpp"

namespace weir::pbf {

struct Options : particles::Scheme {
    int iterations = 4;  // fixed, where tolerance is 0
    real tolerance = 0;  // mean compression at which iterations stop
    int max_iterations = 100;
    real cfm = 1e-4;        // epsilon of eq. 11, in units of 1 / support^2
    real relaxation = 0.6;  // Jacobi over all pairs overshoots: on a lattice its largest eigenvalue is 2.15 (2D), 2.82 (3D), limit 2 / 2.82
    real warm_start = 0.4;  // initial fraction of the last step's multipliers; from 0.5 on, rest is unstable (ADR 10)
    int settle = 300;       // maximum number of iterations that remove the initial density error from the positions
    real pressure_k = 0;    // artificial pressure (eq. 13): k in units of support^2, 0: none
    real pressure_dq = 0.2;  // delta q relative to the support

    Options() : Scheme{particles::Smoothing::cubic, 2} {}
    explicit Options(const scene::Scene& scene);

private:
    void check_vapour(const scene::Scene& scene) const;
};

/// The step [s]: the fastest flow of the scene moves by `cfl` spacings; with output.at = "exact" a whole number of steps between frames.
/// The compression left by a step is proportional to dt^2, and a shorter step would convert the difference to velocity: the step never
/// changes.
template <int D>
real even_step(const scene::Scene& scene, particles::Fluid<D>& fluid);

/// The response of a particle's multiplier to a unit displacement of an adjacent wall: the part of its denominator for a particle beside a
/// wall, half of the lattice's, relaxed [m^2].
template <int D>
real give_at_walls(const Options& options, real spacing);

/// Stability limit: a particle that crosses its support in a step passes others before a correction detects them.
template <int D>
StepLimit stable_step(const Options& options, const particles::Fluid<D>& fluid, real speed);

/// The scene's liquid at the start. Throws BadScene for no-slip walls.
template <int D>
particles::Fluid<D> first_fluid(const scene::Scene& scene);

/// Params is particles::single::PbfParams or particles::plain::PbfParams.
template <class Params, int D>
Params pbf_params(const Options& options, real spacing);

}  // namespace weir::pbf
