#include "pbf/options.hpp"

#include "particles/heat/vapour.hpp"
#include "particles/state/fastest_flow.hpp"
#include "particles/state/flow.hpp"
#include "particles/threads/passes.hpp"
#include "scene/names.hpp"

#include <algorithm>

namespace weir::pbf {

Options::Options(const scene::Scene& scene) {
    read(scene);
    iterations = static_cast<int>(scene.integer("scheme.iterations"));
    tolerance = scene.number("scheme.tolerance");
    max_iterations = static_cast<int>(scene.integer("scheme.max_iterations"));
    cfm = scene.number("scheme.cfm");
    relaxation = scene.number("scheme.relaxation");
    warm_start = scene.number("scheme.warm_start");
    settle = static_cast<int>(scene.integer("scheme.settle"));
    if (const auto* p = scene.effect("artificial_pressure")) {
        pressure_k = p->number("k");
        pressure_dq = p->number("dq");
    }
    if (particles::vapour_is_named(scene)) check_vapour(scene);
}

/// Largest lattice spacing, in particle spacings, at which a particle's density is within a tenth of the lattice's. At larger ones a single
/// particle exceeds the rest density, and no position satisfies its constraint.
template <int D>
real farthest_lattice(const particles::Scheme& scheme) {
    const particles::Kernel<D> w = particles::density_kernel<D>(scheme, 1);
    const auto seen = [&](real spacing) {
        const int reach = static_cast<int>(scheme.support / spacing), last = D == 3 ? reach : 0;
        real sum = 0;
        for (int z = -last; z <= last; ++z)
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x) {
                    const real r = spacing * std::sqrt(static_cast<real>(x * x + y * y + z * z));
                    if (r < scheme.support) sum += w.value(r);
                }
        return sum * std::pow(spacing, D);
    };
    constexpr real piece = 0.01, tenth = 1.1;
    real spacing = 1;
    while (seen(spacing + piece) <= tenth) spacing += piece;
    return spacing;
}

void Options::check_vapour(const scene::Scene& scene) const {
    const real apart = scene.dim() == 2 ? farthest_lattice<2>(*this) : farthest_lattice<3>(*this);
    const real least = scene.number("fluid.density") / std::pow(apart, scene.dim());
    const bool own = scene.text("heat.vapour.name") == "own";
    if (own && scene.number("heat.vapour.density") >= least) return;
    scene.refuse(
        own ? "heat.vapour.density" : "heat.vapour",
        own ? "particles of a vapour of " + scene::number_text(scene.number("heat.vapour.density")) + " kg/m^3 have too few neighbours"
            : "PBF requires neighbours in the vapour too: give heat.vapour a density",
        "heat.vapour.density from " + scene::number_text(std::ceil(least)) +
            " kg/m^3 on, with scheme.support = " + scene::number_text(support));
}

template <int D>
particles::Fluid<D> first_fluid(const scene::Scene& scene) {
    auto fluid = particles::initial_fluid<D>(scene);
    particles::refuse_idle_walls(scene, fluid.domain, false,
                                 "PBF has no viscosity: set slip = \"free\", or use solver = \"sph\" with its viscosity");
    return fluid;
}

template <class Params, int D>
Params pbf_params(const Options& o, real spacing) {
    using Number = decltype(Params::h);
    Params p{};
    particles::set_kernels<D>(p, o, spacing, particles::cell_volume<D>(spacing));  // m / rho0
    const auto w = particles::density_kernel<D>(o, spacing);
    const real h = w.support();
    p.cfm = static_cast<Number>(o.cfm / (h * h));
    p.relaxation = static_cast<Number>(o.relaxation);
    p.corr_k = static_cast<Number>(o.pressure_k * h * h);
    p.corr_inv_wq = static_cast<Number>(particles::profile_factors<D>(o, spacing).density / w.value(o.pressure_dq * h));
    return p;
}

template <int D>
real give_at_walls(const Options& o, real spacing) {
    const auto w = particles::gradient_kernel<D>(o, spacing);
    const int reach = static_cast<int>(std::ceil(o.support));
    real sum = 0;
    for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j)
            for (int k = D == 2 ? 0 : -reach; k <= (D == 2 ? 0 : reach); ++k) {
                const real r = spacing * std::sqrt(1.0 * (i * i + j * j + k * k));
                if (r > 0 && r < w.support()) sum += std::pow(particles::cell_volume<D>(spacing) * w.derivative(r), 2);
            }
    return o.relaxation / (0.5 * sum + o.cfm / (w.support() * w.support()));
}

template <int D>
real even_step(const scene::Scene& scene, particles::Fluid<D>& fluid) {
    const real distance = scene.number("time.cfl") * fluid.domain.spacing, g = norm(fluid.gravity);
    const real speed = particles::fastest_flow(scene, fluid);
    const real longest = std::min({speed > 0 ? distance / speed : infinity, g > 0 ? std::sqrt(distance / g) : infinity,
                                   scene.root().number_or("time.max_dt", infinity)});
    if (longest == infinity) return scene.number("time.end");  // nothing moves
    if (scene.text("output.at") != "exact") return longest;
    const real whole = scene.root().number_or("output.every", longest);
    return whole / std::max<real>(1, std::ceil(whole / longest * (1 - 1e-9)));
}

template <int D>
StepLimit stable_step(const Options& o, const particles::Fluid<D>& fluid, real speed) {
    if (std::isnan(speed)) speed = fluid.max_speed();
    return {speed > 0 ? o.support * fluid.domain.spacing / speed : infinity, "a particle crosses its support in it"};
}

template StepLimit stable_step(const Options&, const particles::Fluid<2>&, real);
template StepLimit stable_step(const Options&, const particles::Fluid<3>&, real);
template real even_step(const scene::Scene&, particles::Fluid<2>&);
template real even_step(const scene::Scene&, particles::Fluid<3>&);
template real give_at_walls<2>(const Options&, real);
template real give_at_walls<3>(const Options&, real);
template particles::Fluid<2> first_fluid(const scene::Scene&);
template particles::Fluid<3> first_fluid(const scene::Scene&);
template particles::single::PbfParams pbf_params<particles::single::PbfParams, 2>(const Options&, real);
template particles::single::PbfParams pbf_params<particles::single::PbfParams, 3>(const Options&, real);
template particles::plain::PbfParams pbf_params<particles::plain::PbfParams, 2>(const Options&, real);
template particles::plain::PbfParams pbf_params<particles::plain::PbfParams, 3>(const Options&, real);

}  // namespace weir::pbf
