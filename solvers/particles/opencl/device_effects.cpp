// The effects of a scene on devices, and the unsupported ones.
#include "particles/opencl/device_fluid.hpp"

namespace weir::particles {

namespace {

/// The supported effects, with the kernels in which they act; forces: those of the method.
std::vector<std::pair<std::string, std::string>> known_effects(const std::string& forces) {
    return {{"gravity", forces},
            {"central_force", forces},
            {"xsph", "smooth"},
            {"vorticity", "confine"},
            {"artificial_pressure", "correct"},
            {"surface_tension", "tension"},
            {"viscosity", "sph_forces"},
            {"artificial_viscosity", "sph_forces"},
            {"density_diffusion", "advance_densities"},
            {"rest_density", "find_pressures"}};
}

std::vector<EffectPlan> plans_of(const scene::Scene& scene) {
    std::vector<EffectPlan> list;
    for (const auto& [name, kernel] : known_effects(scene.solver() == "pbf" ? "predict" : "kick"))
        if (scene.effect(name)) list.push_back({.name = name, .inside = kernel});
    return list;
}

}  // namespace

template <int D>
DeviceEffects<D>::DeviceEffects(const scene::Scene& scene)
    : emitters(scene, Domain<D>(scene)), end(scene.number("time.end")), plans(plans_of(scene)) {
    if (heat_is_named(scene)) heat = std::make_shared<Heat<D>>(scene, Domain<D>(scene));
    if (const auto* e = scene.effect("gravity")) gravity = true, g = e->template vec<D>("g");
    if (const auto* e = scene.effect("central_force"))
        central_force = true, omega = e->number("omega"), centre = e->template vec<D>("centre");
    if (const auto* e = scene.effect("xsph")) xsph = true, smoothing = e->number("c");
    if (const auto* e = scene.effect("vorticity")) vorticity = true, confinement = e->number("epsilon");
}

template struct DeviceEffects<2>;
template struct DeviceEffects<3>;

void refuse_what_devices_lack(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const auto& [name, kernel] : known_effects("")) names.push_back(name);
    refuse_what_lacks("opencl", scene, names);
}

}  // namespace weir::particles
