// What every particle method chooses in "scheme" (kernel, support, backend), and what follows from that alone: the kernels of its sums, the
// walls as those see them, and the numbers of a kernel that the pair physics reads.
#pragma once
#include "backend/device.hpp"
#include "particles/domain.hpp"

#include <string>
#include <vector>

namespace weir::particles {

/// A method's pair of kernels: one for the density, one for its gradient. The order is that of the passes.
enum class Smoothing { muller, cubic, wendland };

struct Scheme {
    Smoothing smoothing = Smoothing::cubic;
    real support = 2;  // over the spacing
    backend::Choice backend{};
    bool facing = false;  // how solids face walls counts for what each hides of the other (kernels/pair.inl)

    /// As the scene says.
    void read(const scene::Scene& scene);
    /// Which of the passes' kernels it is (passes.hpp).
    int kernel() const { return static_cast<int>(smoothing); }
};

/// The key "scheme": kernel, support, the method's own keys, backend. usual: what a scene gets that says nothing.
scene::Key scheme_key(const char* doc, const char* kernel_doc, const Scheme& usual, std::vector<scene::Key> own);
/// Which machinery a scene chose. Throws BadScene where it is none of those known.
backend::Choice backend_of(const scene::Scene& scene);

/// Refuses, all at once, what a backend that looks for the nearest image of a neighbour has not got: effects that are not among these, and
/// periods in which a pair has two images within reach.
void refuse_what_lacks(const std::string& backend, const scene::Scene& scene, const std::vector<std::string>& effects);

template <int D>
Kernel<D> density_kernel(const Scheme& scheme, real spacing);
template <int D>
Kernel<D> gradient_kernel(const Scheme& scheme, real spacing);

/// The walls of the domain as the scheme's kernels see them. Params: single::WallParams or plain::WallParams.
template <class Params, int D>
Params wall_params(const Scheme& scheme, const Domain<D>& domain) {
    Params walls = domain.template walls<Params>(density_kernel<D>(scheme, domain.spacing), gradient_kernel<D>(scheme, domain.spacing));
    walls.facing = scheme.facing ? 1 : 0;
    return walls;
}

/// Times a bare profile of pair.inl: the density kernel, the gradient kernel's slope over r, the Laplacian of the one for viscosity.
struct ProfileFactors {
    real density = 0, gradient = 0, laplacian = 0;
};
template <int D>
ProfileFactors profile_factors(const Scheme& scheme, real spacing);

/// The numbers of the kernels in PbfParams and SphParams, times what a particle adds: its volume or its mass.
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
