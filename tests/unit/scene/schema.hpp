// Schemas of two made-up solvers, so that tests of the reader do not change with the real ones.
#pragma once
#include "scene/scene.hpp"

namespace weir::scene::made_up {

inline SolverSchema smoke_schema() {
    const Key poisson{
        .name = "poisson",
        .type = Type::table,
        .doc = "Pressure solve.",
        .keys = {{.name = "method",
                  .type = Type::choice,
                  .doc = "Method.",
                  .fallback = std::string("multigrid"),
                  .choices = {"multigrid", "cg", "cholmod"}},
                 {.name = "tolerance", .type = Type::number, .doc = "Tolerance.", .fallback = 1e-8, .min = 0, .max = 1, .min_open = true},
                 {.name = "max_iterations", .type = Type::integer, .doc = "Limit.", .fallback = std::int64_t{200}, .min = 1},
                 {.name = "fixed", .type = Type::flag, .doc = "Do all iterations.", .fallback = false}}};
    return {.name = "smoke",
            .doc = "Fluid fills the domain.",
            .keys = {{.name = "scheme",
                      .type = Type::table,
                      .doc = "Numerical methods.",
                      .keys = {{.name = "advection",
                                .type = Type::choice,
                                .doc = "Advection.",
                                .fallback = std::string("maccormack"),
                                .choices = {"maccormack", "semi_lagrangian", "conservative"}},
                               poisson}}},
            .effects = {{"gravity",
                         "Constant acceleration.",
                         {{.name = "g", .type = Type::numbers, .doc = "Acceleration.", .unit = "m/s^2", .required = true, .length = -1}}},
                        {"buoyancy",
                         "Hot fluid rises.",
                         {{.name = "alpha", .type = Type::number, .doc = "Weight of smoke.", .fallback = 0.0},
                          {.name = "beta", .type = Type::number, .doc = "Lift of heat.", .fallback = 0.1}}},
                        {"confinement",
                         "Vorticity confinement.",
                         {{.name = "epsilon", .type = Type::number, .doc = "Strength.", .required = true, .min = 0}}}}};
}

inline SolverSchema water_schema() {
    SolverSchema water = smoke_schema();
    water.name = "water";
    water.doc = "Liquid with a free surface.";
    water.keys.push_back({.name = "time", .type = Type::table, .keys = {{.name = "cfl", .fallback = 1.0}}});
    water.keys.push_back({.name = "liquid", .type = Type::tables, .required = true});
    water.keys.push_back(
        {.name = "markers", .type = Type::integer, .doc = "Markers a cell along an axis.", .fallback = std::int64_t{2}, .min = 1});
    water.effects.push_back({"surface_tension",
                             "Tension.",
                             {{.name = "sigma", .type = Type::number, .doc = "Tension.", .unit = "N/m", .required = true, .min = 0}}});
    return water;
}

inline SolverSchema flat_schema() { return {.name = "flat", .doc = "Works in 2D only.", .dims = {2}}; }

inline std::vector<SolverSchema> schemas() { return {smoke_schema(), water_schema(), flat_schema()}; }

}  // namespace weir::scene::made_up
