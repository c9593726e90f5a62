// What a scene may say to the solver "mac_water".
#include "mac/water.hpp"

namespace weir::mac {

using scene::Key;
using scene::Type;

WaterOptions::WaterOptions(const scene::Scene& scene) {
    const auto& scheme = scene.root().table("scheme");
    const std::string& name = scheme.text("transfer");
    transfer = name == "grid" ? Transfer::grid : name == "pic" ? Transfer::pic : name == "apic" ? Transfer::apic : Transfer::flip;
    flip_blend = scheme.number("flip_blend");
    const std::string& order = scheme.text("trace");
    trace = order == "rk1" ? Trace::rk1 : order == "rk3" ? Trace::rk3 : Trace::rk2;
    const auto& solve = scheme.table("poisson");
    method = solve.text("method");
    poisson.tolerance = solve.number("tolerance");
    poisson.max_iterations = static_cast<int>(solve.integer("max_iterations"));
    poisson.fixed_iterations = solve.flag("fixed");
    cfl = scene.number("time.cfl");
    volume_control = scheme.flag("volume_control");
    reseed = scheme.flag("reseed");
    seed = static_cast<std::uint64_t>(scheme.integer("seed"));
    if (const auto* tension = scene.effect("surface_tension")) sigma = tension->number("sigma");
}

namespace {

std::vector<std::string> pressure_methods() {
    std::vector<std::string> names;
    for (const auto& method : poisson::methods())
        if (!method.whole_box_only) names.push_back(method.name);
    return names;
}

Key poisson_keys() {
    return {.name = "poisson",
            .type = Type::table,
            .doc = "How the pressure equation is solved.",
            .keys = {{.name = "method",
                      .type = Type::choice,
                      .doc = "Method by name.",
                      .fallback = std::string("multigrid"),
                      .choices = pressure_methods()},
                     {.name = "tolerance",
                      .type = Type::number,
                      .doc = "Residual relative to the right-hand side, l2.",
                      .fallback = 1e-8,
                      .min = 0,
                      .min_open = true},
                     {.name = "max_iterations",
                      .type = Type::integer,
                      .doc = "More is a numerical failure, unless `fixed`.",
                      .fallback = std::int64_t{1000},
                      .min = 1},
                     {.name = "fixed", .type = Type::flag, .doc = "Run exactly max_iterations and take what comes.", .fallback = false}}};
}

Key scheme_keys() {
    return {.name = "scheme",
            .type = Type::table,
            .doc = "Numerical methods.",
            .keys = {{.name = "transfer",
                      .type = Type::choice,
                      .doc = "How momentum travels: on the grid (semi-Lagrangian), or on markers (PIC, FLIP, APIC).",
                      .fallback = std::string("flip"),
                      .choices = {"grid", "pic", "flip", "apic"}},
                     {.name = "flip_blend",
                      .type = Type::number,
                      .doc = "Part of FLIP in flip; the rest is PIC.",
                      .fallback = 0.97,
                      .min = 0,
                      .max = 1},
                     {.name = "trace",
                      .type = Type::choice,
                      .doc = "Runge-Kutta scheme that moves markers.",
                      .fallback = std::string("rk2"),
                      .choices = {"rk1", "rk2", "rk3"}},
                     {.name = "volume_control",
                      .type = Type::flag,
                      .doc = "Move the surface so that the volume stays what was poured in; the integral \"volume_shift\" tells how far.",
                      .fallback = true},
                     {.name = "reseed", .type = Type::flag, .doc = "Fill holes among the markers and thin heaps.", .fallback = true},
                     {.name = "seed", .type = Type::integer, .doc = "Of the markers' jitter.", .fallback = std::int64_t{1}, .min = 0},
                     poisson_keys()}};
}

}  // namespace

scene::SolverKind water_kind() {
    scene::SolverSchema schema;
    schema.name = "mac_water";
    schema.doc = "Liquid with a free surface: markers on a staggered grid, level set, second-order surface pressure.";
    schema.dims = {2, 3};
    schema.keys = {{.name = "time", .type = Type::table, .keys = {{.name = "cfl", .type = Type::number, .fallback = 1.0}}}, scheme_keys()};
    schema.effects = {{"gravity",
                       "The same acceleration everywhere.",
                       {{.name = "g", .type = Type::numbers, .doc = "Acceleration.", .unit = "m/s^2", .required = true, .length = -1}}},
                      {"surface_tension",
                       "p = sigma kappa on the surface (ghost-fluid jump).",
                       {{.name = "sigma",
                         .type = Type::number,
                         .doc = "Surface tension.",
                         .unit = "N/m",
                         .required = true,
                         .min = 0,
                         .min_open = true}}}};
    return {schema, [](const scene::Scene& scene) -> std::unique_ptr<Solver> {
                if (scene.dim() == 2) return std::make_unique<Water<2>>(scene);
                return std::make_unique<Water<3>>(scene);
            }};
}

}  // namespace weir::mac
