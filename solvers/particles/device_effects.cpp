// What devices make of a scene's effects, and what they have not got.
#include "particles/device_fluid.hpp"

namespace weir::particles {

template <int D>
DeviceEffects<D>::DeviceEffects(const scene::Scene& scene) : emitters(scene, Domain<D>(scene)), end(scene.number("time.end")) {
    if (const auto* e = scene.effect("gravity")) gravity = true, g = e->template vec<D>("g");
    if (const auto* e = scene.effect("central_force"))
        central_force = true, omega = e->number("omega"), centre = e->template vec<D>("centre");
    if (const auto* e = scene.effect("xsph")) xsph = true, smoothing = e->number("c");
    if (const auto* e = scene.effect("vorticity")) vorticity = true, confinement = e->number("epsilon");
}

template struct DeviceEffects<2>;
template struct DeviceEffects<3>;

namespace {

/// Passes over pairs see the nearest image of a neighbour: of two within reach they would see one.
template <int D>
void check_periods(const scene::Scene& scene, std::vector<scene::Problem>& problems) {
    const Domain<D> domain(scene);
    const real shortest = 2 * scene.number("scheme.support") * domain.spacing;
    for (int a = 0; a < D; ++a)
        if (domain.sides.periodic(a) && domain.hi[a] - domain.lo[a] < shortest)
            problems.push_back(scene.problem(
                "grid.size", "the backend opencl has no periods shorter than two supports",
                "from scheme.support and the cells' size: " + std::to_string(shortest) + " m; or take scheme.backend = \"threads\""));
}

}  // namespace

void refuse_what_devices_lack(const scene::Scene& scene) {
    std::vector<scene::Problem> problems;
    if (scene.dim() == 2)
        check_periods<2>(scene, problems);
    else
        check_periods<3>(scene, problems);
    if (!problems.empty()) scene.refuse(std::move(problems));
}

}  // namespace weir::particles
