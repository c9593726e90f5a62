// What devices make of a scene's effects, and what they have not got.
#include "particles/device_fluid.hpp"

namespace weir::particles {

namespace {

/// The kernels in which effects act, by scene.
std::vector<EffectPlan> plans_of(const scene::Scene& scene) {
    const std::string forces = scene.solver() == "pbf" ? "predict" : "kick";
    std::vector<EffectPlan> list;
    for (const auto& [name, kernel] : {std::pair<std::string, std::string>{"gravity", forces},
                                       {"central_force", forces},
                                       {"xsph", "smooth"},
                                       {"vorticity", "confine"},
                                       {"artificial_pressure", "correct"},
                                       {"surface_tension", "tension"},
                                       {"viscosity", "sph_forces"},
                                       {"artificial_viscosity", "sph_forces"},
                                       {"density_diffusion", "advance_densities"},
                                       {"rest_density", "find_pressures"}})
        if (scene.effect(name)) list.push_back({.name = name, .inside = kernel});
    return list;
}

}  // namespace

template <int D>
DeviceEffects<D>::DeviceEffects(const scene::Scene& scene)
    : emitters(scene, Domain<D>(scene)), end(scene.number("time.end")), plans(plans_of(scene)) {
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
