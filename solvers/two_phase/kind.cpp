// The schema of the solver "two_phase".
#include "mac/grid/kind.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/own_planes.hpp"
#include "scene/one_process.hpp"
#include "two_phase/effects.hpp"
#include "two_phase/solver.hpp"

namespace weir::two_phase {

using scene::Key;
using scene::Type;

const mac::EffectKinds& body_forces() {
    static const mac::EffectKinds kinds{mac::gravity(), mac::rotating_frame()};
    return kinds;
}

std::vector<scene::Variant> effect_schemas() {
    std::vector<scene::Variant> list = schemas_of(body_forces());
    list.push_back(
        {"surface_tension",
         "Tension of the interface, in balance with the pressure; contact angles are 90 degrees.",
         {{.name = "sigma", .type = Type::number, .doc = "Surface tension.", .unit = "N/m", .required = true, .min = 0, .min_open = true}},
         {"sigma"}});
    list.push_back(
        {"viscosity", "Viscous stress of both fluids, with fluid.viscosity and gas.viscosity; implicit.", {}, {"fluid.viscosity"}});
    list.push_back(Heat<2>::schema());
    list.push_back(geometry::brush_schema());
    return list;
}

namespace {

Key fluid_key() { return {.name = "fluid", .type = Type::table, .keys = Heat<2>::keys_of_a_fluid()}; }

Key gas_key() {
    Key gas{.name = "gas",
            .type = Type::table,
            .doc = "Properties of the gas, which fills what the liquid leaves.",
            .required = true,
            .keys = {{.name = "density",
                      .type = Type::number,
                      .doc = "Density.",
                      .unit = "kg/m^3",
                      .required = true,
                      .min = 0,
                      .min_open = true,
                      .example = "density = 1.2"},
                     {.name = "viscosity",
                      .type = Type::number,
                      .doc = "Kinematic viscosity. It acts only if effects.viscosity is named.",
                      .unit = "m^2/s",
                      .fallback = 0.0,
                      .min = 0}},
            .example = "gas = { density = 1.2, viscosity = 1.5e-5 }"};
    for (Key& key : Heat<2>::keys_of_a_fluid()) gas.keys.push_back(std::move(key));
    return gas;
}

Key start_keys() {
    Key initial = initial_keys();
    initial.keys.push_back({.name = "liquid_velocity",
                            .type = Type::numbers,
                            .doc = "Velocity of the liquid at t = 0, instead of `velocity`; the pressure makes both divergence-free.",
                            .unit = "m/s",
                            .length = -1});
    initial.keys.push_back({.name = "liquid_temperature",
                            .type = Type::number,
                            .doc = "Temperature of the liquid at t = 0, instead of `temperature`. Requires effects.heat.",
                            .unit = "K"});
    return initial;
}

Key entering_key(std::string doc, std::string fallback) {
    return {.name = "fluid", .type = Type::choice, .doc = std::move(doc), .fallback = std::move(fallback), .choices = {"liquid", "gas"}};
}
constexpr const char* of_open_sides = "What stands outside: it enters where the flow is inwards.";

/// What enters through each inflow and open side.
Key side_keys() {
    Key sides{.name = "sides", .type = Type::table};
    for (const std::string axis : {"x", "y", "z"})
        for (const std::string end : {"_min", "_max"})
            sides.keys.push_back({.name = axis + end,
                                  .type = Type::table,
                                  .selector = "kind",
                                  .variants = {{"inflow", "", {entering_key("What enters.", "liquid")}},
                                               {"outflow", "", {entering_key(of_open_sides, "gas")}},
                                               {"open", "", {entering_key(of_open_sides, "gas")}}}});
    return sides;
}

void check_parallel(const scene::Scene& scene) {
    if (scene.effect("viscosity")) scene::one_process_only(scene, "effects.viscosity", "viscosity of two phases is");
    if (scene.effect("heat")) scene::one_process_only(scene, "effects.heat", "heat of two phases is");
    if (scene.has("solids"))
        for (const auto& solid : scene.root().tables("solids"))
            if (solid.has("motion")) scene::one_process_only(scene, "solids", "moving solids among two phases are");
    scene::refuse_bodies(scene);
    scene::refuse_brush(scene);
}

}  // namespace

scene::SolverKind kind() {
    scene::SolverSchema schema;
    schema.name = "two_phase";
    schema.doc = "Liquid and gas with an interface, both incompressible: geometric volume of fluid with momentum in the same fluxes.";
    schema.keys = {{.name = "time",
                    .type = Type::table,
                    .keys = {{.name = "cfl",
                              .type = Type::number,
                              .doc = "Fraction of a cell that the fastest fluid may leave in one step, all axes together.",
                              .fallback = 0.5,
                              .max = 0.5}}},
                   fluid_key(),
                   gas_key(),
                   side_keys(),
                   rigid::bodies_key(),
                   rigid::joints_key(),
                   rigid::probe_key(),
                   scheme_key({PoissonChoice::key()}),
                   start_keys()};
    schema.effects = effect_schemas();
    schema.without = {"emitters", "sides.*.smoke", "sides.*.profile", "initial.smoke"};
    schema.why_without =
        "this solver has walls, inflows, p = 0 on open sides, periodic axes, bodies, and solids, at rest or in a prescribed motion; "
        "\"mac_water\" has emitters and a change of phase";
    return {schema,
            [](const scene::Scene& scene, const Partition& partition) { return mac::make<TwoPhase>(scene, partition); },
            {{"velocity", "pressure", fraction_name, level_set_name},
             {"transport momentum", "transport liquid", "densities", "project"},
             "liquid = [ { shape = \"box\", min = <0.0>, max = <0.5> } ]\ngas.density = 1.2\ninitial.velocity = \"random\""},
            {.check = check_parallel, .replicated_work = mac::replicated_pressure, .distributed_storage = mac::holds_own_planes}};
}

}  // namespace weir::two_phase
