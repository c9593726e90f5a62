// What devices make of a scene's effects, and what they have not got.
#include "particles/device_fluid.hpp"

namespace weir::particles {

template <int D>
DeviceEffects<D>::DeviceEffects(const scene::Scene& scene) {
    if (const auto* e = scene.effect("gravity")) gravity = true, g = e->template vec<D>("g");
    if (const auto* e = scene.effect("central_force"))
        central_force = true, omega = e->number("omega"), centre = e->template vec<D>("centre");
    if (const auto* e = scene.effect("xsph")) xsph = true, smoothing = e->number("c");
    if (const auto* e = scene.effect("vorticity")) vorticity = true, confinement = e->number("epsilon");
}

template struct DeviceEffects<2>;
template struct DeviceEffects<3>;

void refuse_what_devices_lack(const scene::Scene& scene) {
    std::vector<scene::Problem> problems;
    const auto refuse = [&](const std::string& key, const std::string& what) {
        problems.push_back(scene.problem(key, "the backend opencl has no " + what,
                                         "known to it: walls, forces, effects; take scheme.backend = \"threads\""));
    };
    for (const char* list : {"solids", "emitters", "sinks"})
        if (scene.has(list) && !scene.root().tables(list).empty()) refuse(list, list);
    const auto check_sides = [&](const auto& sides, int dim) {
        for (int a = 0; a < dim; ++a)
            for (int end = 0; end < 2; ++end) {
                const auto kind = sides.side(a, end).kind;
                if (kind == geometry::SideKind::wall || kind == geometry::SideKind::moving_wall) continue;
                const std::string side = std::string(1, "xyz"[a]) + (end ? "_max" : "_min");
                refuse("sides." + side, sides.periodic(a) ? "periodic sides" : "open sides");
            }
    };
    if (scene.dim() == 2)
        check_sides(geometry::Sides<2>(scene), 2);
    else
        check_sides(geometry::Sides<3>(scene), 3);
    if (!problems.empty()) scene.refuse(std::move(problems));
}

}  // namespace weir::particles
