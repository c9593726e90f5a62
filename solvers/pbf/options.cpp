#include "pbf/options.hpp"

#include "particles/fastest_flow.hpp"
#include "particles/isa.hpp"
#include "particles/passes.hpp"

#include <algorithm>

namespace weir::pbf {

using particles::Kernel;
using particles::KernelKind;

Options::Options(const scene::Scene& scene) {
    const std::string& name = scene.text("scheme.kernel");
    smoothing = name == "cubic" ? Smoothing::cubic : name == "wendland" ? Smoothing::wendland : Smoothing::muller;
    support = scene.number("scheme.support");
    iterations = static_cast<int>(scene.integer("scheme.iterations"));
    tolerance = scene.number("scheme.tolerance");
    max_iterations = static_cast<int>(scene.integer("scheme.max_iterations"));
    cfm = scene.number("scheme.cfm");
    relaxation = scene.number("scheme.relaxation");
    warm_start = scene.number("scheme.warm_start");
    settle = static_cast<int>(scene.integer("scheme.settle"));
    backend = particles::backend_of(scene);
    if (const auto* p = scene.effect("artificial_pressure")) {
        pressure_k = p->number("k");
        pressure_dq = p->number("dq");
    }
}

template <int D>
Kernel<D> density_kernel(const Options& o, real spacing) {
    const KernelKind kinds[] = {KernelKind::poly6, KernelKind::cubic, KernelKind::wendland};
    return {kinds[static_cast<int>(o.smoothing)], o.support * spacing};
}
template <int D>
Kernel<D> gradient_kernel(const Options& o, real spacing) {
    const KernelKind kinds[] = {KernelKind::spiky, KernelKind::cubic, KernelKind::wendland};
    return {kinds[static_cast<int>(o.smoothing)], o.support * spacing};
}

template <class Params, int D>
Params pbf_params(const Options& o, real spacing) {
    using Number = decltype(Params::h);
    const Kernel<D> w = density_kernel<D>(o, spacing), g = gradient_kernel<D>(o, spacing);
    const real h = w.support(), volume = particles::cell_volume<D>(spacing);  // m / rho0
    const real h3 = h * h * h, h5 = h3 * h * h, h6 = h3 * h3;
    real density = 0, gradient = 0;  // so that density * profile = volume * W, and gradient * slope profile = volume * W' / r
    switch (o.smoothing) {
        case Smoothing::muller:
            density = w.scale() / h6, gradient = -3 * g.scale() / h3;
            break;
        case Smoothing::cubic:
            density = 2 * w.scale() / h3, gradient = -6 * g.scale() / h3;
            break;
        case Smoothing::wendland:
            density = w.scale() / h5, gradient = -20 * g.scale() / h5;
            break;
    }
    Params p{};
    p.h = static_cast<Number>(h);
    p.h2 = static_cast<Number>(h * h);
    p.guard = static_cast<Number>(1e-10 * h * h);
    p.self = static_cast<Number>(volume * w.value(0));
    p.density = static_cast<Number>(volume * density);
    p.gradient = static_cast<Number>(volume * gradient);
    p.cfm = static_cast<Number>(o.cfm / (h * h));
    p.relaxation = static_cast<Number>(o.relaxation);
    p.corr_k = static_cast<Number>(o.pressure_k * h * h);
    p.corr_inv_wq = static_cast<Number>(density / w.value(o.pressure_dq * h));
    return p;
}

template <int D>
real even_step(const scene::Scene& scene, particles::Fluid<D>& fluid) {
    const real distance = scene.number("time.cfl") * fluid.domain.spacing, g = norm(fluid.gravity);
    const real speed = particles::fastest_flow(scene, fluid);
    const real longest = std::min({speed > 0 ? distance / speed : infinity, g > 0 ? std::sqrt(distance / g) : infinity,
                                   scene.root().number_or("time.max_dt", infinity)});
    const real frame = std::min(scene.root().number_or("output.every", infinity), scene.number("time.end"));
    return frame / std::max<real>(1, std::ceil(frame / longest * (1 - 1e-9)));
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
template Kernel<2> density_kernel(const Options&, real);
template Kernel<3> density_kernel(const Options&, real);
template Kernel<2> gradient_kernel(const Options&, real);
template Kernel<3> gradient_kernel(const Options&, real);
template particles::single::PbfParams pbf_params<particles::single::PbfParams, 2>(const Options&, real);
template particles::single::PbfParams pbf_params<particles::single::PbfParams, 3>(const Options&, real);
template particles::plain::PbfParams pbf_params<particles::plain::PbfParams, 2>(const Options&, real);
template particles::plain::PbfParams pbf_params<particles::plain::PbfParams, 3>(const Options&, real);

}  // namespace weir::pbf
