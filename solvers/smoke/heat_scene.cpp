// Heat settings of a scene for the solver "mac": substance, conduction, heat from sides and heaters, initial temperatures.
#include "core/error.hpp"
#include "geometry/shape.hpp"
#include "scene/names.hpp"
#include "smoke/heat.hpp"
#include "thermo/heat_keys.hpp"
#include "thermo/scene_substance.hpp"

#include <algorithm>

namespace weir::smoke {

using scene::Key;
using scene::Type;

template <int D>
std::vector<Key> Heat<D>::keys() {
    return thermo::keys_on_a_grid(
        "heat, melting and freezing be simulated",
        {{.name = "conduction",
          .type = Type::choice,
          .doc = "First-order scheme in time. stages: as many explicit stages as the step requires; explicit: one stage, which limits the "
                 "step to about rho c h^2/(6 dim k).",
          .fallback = std::string("stages"),
          .choices = {"stages", "explicit"}},
         {.name = "lift",
          .type = Type::number,
          .doc = "Gravity of the Boussinesq buoyancy of the melt along y, relative to its melting point, by the substance's expansion.",
          .unit = "m/s^2",
          .fallback = 0.0}},
        "the cells whose centres they cover.");
}

template <int D>
void Heat<D>::needs(FieldPlan& plan) {
    plan.advected("enthalpy").advected("temperature");
}

template <int D>
Heat<D>::Heat(const scene::Scene& scene, MacState<D>& s)
    : substance_(thermo::substance_of(scene)),
      melting_(thermo::melting_of(scene, "mac")),
      gravity_(scene.number("heat.lift")),
      cfl_(scene.number("time.cfl")),
      drag_(scene.number("heat.drag")),
      explicit_(scene.text("heat.conduction") == "explicit"),
      beside_flow_(scheme_of(scene) == Scheme::conservative) {
    if (gravity_ != 0) lightness_.emplace(scene);
    if (const auto* buoyancy = scene.effect("buoyancy"); buoyancy && gravity_ != 0 && buoyancy->number("beta") != 0)
        scene.refuse("effects.buoyancy.beta", "heat.lift already applies buoyancy by the substance's expansion", "give one of them");
    if (scene.effect("cooling"))
        scene.refuse("effects.cooling", "cooling sets a temperature, and a scene with a substance conserves heat",
                     "heaters with a negative power, or sides with a temperature");
    if (const auto* diffusion = scene.effect("diffusion"); diffusion && diffusion->has("temperature"))
        scene.refuse("effects.diffusion.temperature", "the substance has its own conductivity");
    for (std::size_t i = 0; i < scene.root().tables("emitters").size(); ++i)
        if (scene.root().tables("emitters")[i].has("temperature"))
            scene.refuse("emitters[" + std::to_string(i) + "].temperature",
                         "an emitter that sets a temperature violates the heat balance of a substance", "use heaters, which have a power");
    auto& temperature = s.field("temperature");
    temperature.derived = true;
    liquid_ = Grid<real, D>(s.extent());
    coldest_.resize(static_cast<std::size_t>(s.extent()[D - 1]));
    conduction_ = Conduction<D>(melting_, s.extent(), s.u.h, s.rho, temperature.boundary);
    supply_ = HeatSupply<D>(scene, s, melting_, conduction_);
    supply_.refuse_heaters_without_fluid(scene, s);
    read_sides(s);
}

/// Inflow has the enthalpy of its temperature.
template <int D>
void Heat<D>::read_sides(MacState<D>& s) {
    auto& enthalpy = s.field("enthalpy").boundary;
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            const auto& side = s.sides.side(a, end);
            const bool passes = side.kind == geometry::SideKind::inflow || side.kind == geometry::SideKind::outflow;
            if (side.temperature && passes)
                enthalpy.end[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)] = {
                    EndRule::Kind::dirichlet, melting_.enthalpy(*side.temperature), {}};
        }
}

template <int D>
void Heat<D>::start(MacState<D>& s, const scene::Scene& scene) {
    auto &h = s["enthalpy"], &T = s["temperature"];
    const real coldest = -max_over(s.extent(), [&](const Index<D>& I) { return -T(I); });
    const char* place = scene.has("initial.temperature") ? "initial.temperature" : "substance";
    if (!(coldest > 0))
        scene.refuse(place, "the lowest temperature is " + scene::number_text(coldest) + " K at the start", "it must be greater than 0 K");
    for_each_cell(s.extent(), [&](const Index<D>& I) { h(I) = melting_.enthalpy(T(I)); });
    const real most = max_over(s.extent(), [&](const Index<D>& I) { return h(I); });
    if (most > melting_.boils_above)
        scene.refuse(place, "at " + scene::number_text(melting_.temperature(most)) + " K the liquid boils", "solver \"mac\" has no vapour");
    note(s);
}

#define WEIR_INSTANTIATE(D)                                    \
    template std::vector<Key> Heat<D>::keys();                 \
    template void Heat<D>::needs(FieldPlan&);                  \
    template Heat<D>::Heat(const scene::Scene&, MacState<D>&); \
    template void Heat<D>::read_sides(MacState<D>&);           \
    template void Heat<D>::start(MacState<D>&, const scene::Scene&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::smoke
