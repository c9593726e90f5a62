// The choices of a PBF scene ("scheme" and two effects), and the numbers that the pair physics reads, made from them.
#pragma once
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
    real cfm = 1e-4;         // epsilon of eq. 11, in units of 1 / support^2
    real relaxation = 0.7;   // Jacobi over all pairs overshoots: its iteration matrix has eigenvalues up to 2.8 for a support of 2 spacings
    real warm_start = 0.55;  // part of the last step's multipliers that the iterations start from; at 0.8 a liquid at rest boils (ADR 10)
    int settle = 300;        // at most so many iterations that take the initial density error out of the positions
    real pressure_k = 0;     // artificial pressure (eq. 13): k in units of support^2, 0: none
    real pressure_dq = 0.2;  // delta q over the support
    std::string isa = "auto";

    Options() = default;
    explicit Options(const scene::Scene& scene);
};

template <int D>
particles::Kernel<D> density_kernel(const Options& options, real spacing);
template <int D>
particles::Kernel<D> gradient_kernel(const Options& options, real spacing);

/// Params is particles::single::PbfParams or particles::plain::PbfParams.
template <class Params, int D>
Params pbf_params(const Options& options, real spacing);

}  // namespace weir::pbf
