#include "water/effects.hpp"

#include "free_surface/start.hpp"
#include "geometry/brush.hpp"

namespace weir::water {

using scene::Type;

const EffectKinds& body_forces() {
    static const EffectKinds kinds{gravity(), rotating_frame()};
    return kinds;
}

std::vector<scene::Variant> effect_schemas() {
    std::vector<scene::Variant> list = schemas_of(body_forces());
    const std::vector<scene::Variant> own{{"surface_tension",
                                           "p = sigma kappa on the surface (ghost-fluid jump).",
                                           {{.name = "sigma",
                                             .type = Type::number,
                                             .doc = "Surface tension.",
                                             .unit = "N/m",
                                             .required = true,
                                             .min = 0,
                                             .min_open = true,
                                             .steerable = true}},
                                           {"sigma"}},
                                          {"viscosity",
                                           "Viscous friction of the liquid with fluid.viscosity; no stress on the free surface.",
                                           {{.name = "scheme",
                                             .type = Type::choice,
                                             .doc = "Scheme in time.",
                                             .fallback = std::string("crank-nicolson"),
                                             .choices = {"crank-nicolson", "implicit"}}},
                                           {"fluid.viscosity"}},
                                          free_surface::volume_control()};
    list.insert(list.end(), own.begin(), own.end());
    list.push_back(geometry::brush_schema());
    return list;
}

}  // namespace weir::water
