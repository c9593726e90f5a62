// The options common to all particle methods in "scheme" (kernel, support, backend) and their consequences: kernels, walls, and kernel
// parameters of the pair physics.
#pragma once
#include "backend/device.hpp"
#include "particles/state/domain.hpp"

#include <string>
#include <vector>

namespace weir::particles {

/// A method's pair of kernels: one for the density, one for its gradient. The order is that of the passes.
enum class Smoothing { muller, cubic, wendland };

struct Scheme {
    Smoothing smoothing = Smoothing::cubic;
    real support = 2;  // relative to the spacing
    backend::Choice backend{};
    bool facing = false;  // the orientation of solids to walls corrects their common part (kernels/pair.inl)

    /// Reads the scene's options.
    void read(const scene::Scene& scene);
    /// Index of the passes' kernel (passes.hpp).
    int kernel() const { return static_cast<int>(smoothing); }
};

/// The key "scheme": kernel, support, the method's own keys, backend. usual: the defaults.
scene::Key scheme_key(const char* doc, const char* kernel_doc, const Scheme& usual, std::vector<scene::Key> own);
/// The backend of a scene. Throws BadScene for an unknown one.
backend::Choice backend_of(const scene::Scene& scene);

/// Rejects, in one message, features missing in a backend that uses the nearest image of a neighbour: effects not in this list, and periods
/// in which a pair has two images within reach.
void refuse_what_lacks(const std::string& backend, const scene::Scene& scene, const std::vector<std::string>& effects);

template <int D>
Kernel<D> density_kernel(const Scheme& scheme, real spacing);
template <int D>
Kernel<D> gradient_kernel(const Scheme& scheme, real spacing);

/// The walls of the domain for the scheme's kernels. Params: single::WallParams or plain::WallParams.
template <class Params, int D>
Params wall_params(const Scheme& scheme, const Domain<D>& domain) {
    Params walls = domain.template walls<Params>(density_kernel<D>(scheme, domain.spacing), gradient_kernel<D>(scheme, domain.spacing));
    walls.facing = scheme.facing ? 1 : 0;
    return walls;
}

/// Factors of the bare profiles of pair.inl: the density kernel, the gradient kernel's slope over r, the Laplacian of the viscosity kernel.
struct ProfileFactors {
    real density = 0, gradient = 0, laplacian = 0;
};
template <int D>
ProfileFactors profile_factors(const Scheme& scheme, real spacing);

/// The kernel factors in PbfParams and SphParams, times a particle's volume or mass.
template <int D, class Params>
void set_kernels(Params& p, const Scheme& scheme, real spacing, real particle) {
    using Number = decltype(Params::h);
    const Kernel<D> w = density_kernel<D>(scheme, spacing);
    const ProfileFactors factors = profile_factors<D>(scheme, spacing);
    const real h = w.support();
    p.h = static_cast<Number>(h);
    p.h2 = static_cast<Number>(h * h);
    p.guard = static_cast<Number>(1e-10 * h * h);
    p.self = static_cast<Number>(particle * w.value(0));
    p.density = static_cast<Number>(particle * factors.density);
    p.gradient = static_cast<Number>(particle * factors.gradient);
}

}  // namespace weir::particles
