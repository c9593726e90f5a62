// The schema of the solver "mac_water".
#include "mac/grid/kind.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/own_planes.hpp"
#include "scene/one_process.hpp"
#include "scene/surface_keys.hpp"
#include "thermo/heat_keys.hpp"
#include "water/effects.hpp"
#include "water/solver.hpp"

namespace weir::water {

using scene::Key;
using scene::Type;

WaterOptions::WaterOptions(const scene::Scene& scene) {
    const auto& scheme = scene.root().table("scheme");
    const std::string& name = scheme.text("transfer");
    transfer = name == "grid" ? Transfer::grid : name == "pic" ? Transfer::pic : name == "apic" ? Transfer::apic : Transfer::flip;
    flip_blend = scheme.number("flip_blend");
    const std::string& order = scheme.text("trace");
    trace = order == "rk1" ? Trace::rk1 : order == "rk3" ? Trace::rk3 : Trace::rk2;
    poisson = PoissonChoice(scheme.table("poisson"));
    cfl = scene.number("time.cfl");
    reseed = scheme.flag("reseed");
    seed = static_cast<std::uint64_t>(scheme.integer("seed"));
    volume_control = scene.effect("volume_control") != nullptr;
    encloses_air = scene.root().text_or("air", "empty") == "enclosed";
    if (encloses_air && scene.has("enclosed_gas"))
        enclosed_gas = GasLaw{scene.number("enclosed_gas.pressure"), scene.number("enclosed_gas.exponent")};
    if (const auto* tension = scene.effect("surface_tension")) sigma = tension->number("sigma");
    if (const auto* friction = scene.effect("viscosity")) viscosity = friction->text("scheme") == "implicit" ? 1 : 0.5;
}

namespace {

Key scheme_keys() {
    return {
        .name = "scheme",
        .type = Type::table,
        .doc = "Numerical methods.",
        .keys = {
            {.name = "transfer",
             .type = Type::choice,
             .doc = "Advection of momentum: on the grid (semi-Lagrangian), or on markers (PIC, FLIP, APIC).",
             .fallback = std::string("flip"),
             .choices = {"grid", "pic", "flip", "apic"}},
            {.name = "flip_blend",
             .type = Type::number,
             .doc = "Fraction of FLIP in method flip; the rest is PIC.",
             .fallback = 0.97,
             .min = 0,
             .max = 1,
             .steerable = true},
            {.name = "trace",
             .type = Type::choice,
             .doc = "Runge-Kutta scheme that moves markers.",
             .fallback = std::string("rk2"),
             .choices = {"rk1", "rk2", "rk3"}},
            {.name = "reseed", .type = Type::flag, .doc = "Insert markers in gaps and remove them where they are dense.", .fallback = true},
            {.name = "seed", .type = Type::integer, .doc = "Seed of the markers' jitter.", .fallback = std::int64_t{1}, .min = 0},
            PoissonChoice::key()}};
}

Key air_key() {
    return {.name = "air",
            .type = Type::choice,
            .doc =
                "Air: empty (p = 0 on the surface), if absent; enclosed: air that touches no open side and no emitter keeps its volume, "
                "or has p V^exponent = const with `enclosed_gas`; flow: only in the solver two_phase.",
            .choices = {"empty", "enclosed", "flow"}};
}

Key enclosed_gas_key() {
    return {.name = "enclosed_gas",
            .type = Type::table,
            .doc = "Air of pockets that can be squeezed, for air = \"enclosed\"; without this table it is incompressible.",
            .keys = {{.name = "pressure",
                      .type = Type::number,
                      .doc = "Absolute pressure of the open air, and of air when it is enclosed.",
                      .unit = "Pa",
                      .required = true,
                      .min = 0,
                      .min_open = true,
                      .example = "pressure = 101325"},
                     {.name = "exponent",
                      .type = Type::number,
                      .doc = "Exponent: 1.4 for air without exchange of heat, 1 at constant temperature.",
                      .fallback = 1.4,
                      .min = 1}},
            .example = "enclosed_gas = { pressure = 101325, exponent = 1.4 }"};
}

/// Rejects keys of a scene that are not supported in parallel.
void check_parallel(const scene::Scene& scene) {
    if (scene.root().text_or("air", "empty") == "enclosed") scene::one_process_only(scene, "air", "pockets of air are");
    scene::refuse_bodies(scene);
    if (LiquidHeat<2>::named(scene)) scene::one_process_only(scene, "substance", "melting and boiling of a substance are");
    scene::refuse_brush(scene);
}

}  // namespace

scene::SolverKind kind() {
    scene::SolverSchema schema;
    schema.name = "mac_water";
    schema.doc = "Liquid with a free surface: markers on a staggered grid, level set, second-order surface pressure.";
    schema.dims = {2, 3};
    schema.keys = {{.name = "time", .type = Type::table, .keys = {{.name = "cfl", .type = Type::number, .fallback = 1.0}}},
                   rigid::bodies_key(),
                   rigid::joints_key(),
                   rigid::probe_key(),
                   scheme_keys(),
                   initial_keys(),
                   air_key(),
                   enclosed_gas_key(),
                   scene::surface_key_of_level_set(true)};
    Key sides{.name = "sides", .type = Type::table};
    for (const char* axis : {"x", "y", "z"})
        for (const char* end : {"_min", "_max"}) {
            Key side{.name = std::string(axis) + end, .type = Type::table};
            side.variants = {thermo::wall_with_exchange()};
            sides.keys.push_back(std::move(side));
        }
    schema.keys.push_back(std::move(sides));
    for (Key& key : LiquidHeat<2>::keys()) schema.keys.push_back(std::move(key));
    schema.effects = effect_schemas();
    schema.without = {"sides.*.smoke", "sides.*.profile", "emitters.temperature", "emitters.smoke", "initial.smoke"};
    return {schema,
            [](const scene::Scene& scene, const Partition& partition) { return mac::make<Water>(scene, partition); },
            {{"velocity", "pressure", "level_set", "position", "velocity"},
             {"sort markers", "redistribute markers", "move surface", "level set", "markers to faces", "walls", "project", "extrapolate",
              "faces to markers"},
             "liquid = [ { shape = \"box\", min = <0.0>, max = <0.5> } ]\ninitial.velocity = \"random\""},
            {.check = check_parallel,
             .replicated_work =
                 [](const scene::Scene& scene, const Partition& cut) {
                     auto works = mac::replicated_pressure(scene, cut);
                     works.push_back(scene::ReplicatedWork::level_set_in_solids);
                     return works;
                 },
             .distributed_storage = mac::holds_own_planes,
             .work_of_planes = work_of_planes}};
}

}  // namespace weir::water
