// The schema of the solver "heightfield".
#include "heightfield/columns.hpp"
#include "heightfield/effects.hpp"
#include "heightfield/shallow_water.hpp"
#include "heightfield/solver.hpp"
#include "scene/formula.hpp"
#include "scene/one_process.hpp"

namespace weir::heightfield {

namespace {

using scene::Key;
using scene::Type;

Key scheme_keys() {
    return {.name = "scheme",
            .type = Type::table,
            .doc = "Numerical methods.",
            .keys = {{.name = "model",
                      .type = Type::choice,
                      .doc = "shallow_water: nonlinear shallow-water equations, with currents and dry ground. columns: linear wave "
                             "equation of real-time graphics, where each column is accelerated by the heights of its neighbours, with "
                             "floating and dragged objects.",
                      .fallback = std::string("shallow_water"),
                      .choices = {"shallow_water", "columns"}},
                     {.name = "limiter",
                      .type = Type::choice,
                      .doc = "Slope limiter of depth, surface and velocity. none: first order; mc: the sharpest, which leaves ripples in "
                             "steady flow over a bed with corners, where van_leer converges.",
                      .fallback = std::string("mc"),
                      .choices = {"none", "minmod", "van_leer", "mc"}},
                     {.name = "dry_depth",
                      .type = Type::number,
                      .doc = "Depth below which water does not move. The relative error of fronts on dry ground is up to three times this "
                             "over the water's depth.",
                      .unit = "m",
                      .fallback = 1e-6,
                      .min = 0,
                      .min_open = true}}};
}

Key terrain_key() {
    const Key file{.name = "file", .type = Type::text, .doc = "Path relative to the scene's folder.", .required = true};
    const auto height = [](const char* name, const char* doc) {
        return Key{.name = name, .type = Type::number, .doc = doc, .unit = "m", .required = true};
    };
    return {.name = "terrain",
            .type = Type::table,
            .doc = "Height of the bed; the floor of the domain if absent.",
            .selector = "kind",
            .variants = {{"formula",
                          "A formula of x, and of z in 3D: numbers, pi, + - * / ^ ( ), functions such as sin, exp, max.",
                          {{.name = "height", .type = Type::text, .doc = "The formula.", .unit = "m", .required = true}}},
                         {"asc",
                          "An ESRI ASCII grid; bilinear between the centres of its cells. Its y axis is z here.",
                          {file,
                           {.name = "corner",
                            .type = Type::numbers,
                            .doc = "Position of its lower corner, x and z, instead of that in the file.",
                            .unit = "m",
                            .length = 2},
                           {.name = "nodata", .type = Type::number, .doc = "Height of cells without data.", .unit = "m"}}},
                         {"image",
                          "A grey map (PGM) over the whole domain, its upper row at the least z.",
                          {file, height("black", "Height of black pixels."), height("white", "Height of white pixels.")}}}};
}

Key initial_key() {
    const auto speed = [](const char* name, int only_dim) {
        return Key{.name = name,
                   .type = Type::text,
                   .doc = std::string("Along ") + name + ", a formula.",
                   .unit = "m/s",
                   .fallback = std::string("0"),
                   .only_dim = only_dim};
    };
    Key velocity{.name = "velocity", .type = Type::table};
    velocity.variants = {{"formula", "Formulas of x, and of z in 3D.", {speed("x", 0), speed("z", 3)}}};
    return {.name = "initial",
            .type = Type::table,
            .keys = {{.name = "surface",
                      .type = Type::text,
                      .doc = "Height of the water's surface, a formula of x, and of z in 3D; columns where it is below the bed are dry. "
                             "Alternative to liquid.",
                      .unit = "m"},
                     velocity}};
}

/// Sides with a prescribed inflow or water level.
Key sides_key() {
    Key sides{.name = "sides", .type = Type::table};
    for (const char* axis : {"x", "z"})
        for (const char* end : {"_min", "_max"}) {
            Key side{.name = std::string(axis) + end, .type = Type::table};
            side.variants = {{"discharge",
                              "Inflow of a given discharge, with a depth that matches the interior flow.",
                              {{.name = "discharge",
                                .type = Type::number,
                                .doc = "Discharge per metre of the side.",
                                .unit = "m^2/s",
                                .required = true,
                                .min = 0}}},
                             {"level",
                              "Open to water with a given surface height; supercritical flow leaves independently of it.",
                              {{.name = "level", .type = Type::number, .doc = "Surface height.", .unit = "m", .required = true}}}};
            sides.keys.push_back(std::move(side));
        }
    return sides;
}

Key grid_key() {
    return {.name = "grid",
            .type = Type::table,
            .keys = {{.name = "cells",
                      .type = Type::integers,
                      .doc = "Number of cells along each axis. A column of a height field is one cell: the number along y is ignored (it "
                             "applies to other solvers of the same scene)."}}};
}

Key floats_key() {
    const auto point = [](const char* name, const char* doc) {
        return Key{.name = name, .type = Type::numbers, .doc = doc, .unit = "m", .required = true, .length = -1};
    };
    return {.name = "floats",
            .type = Type::tables,
            .doc = "Boxes that float in the water, or are dragged through it; for scheme.model = \"columns\".",
            .keys = {
                point("size", "Extent along each axis."),
                point("at", "Centre of its underside at t = 0."),
                {.name = "density", .type = Type::number, .doc = "Density relative to water.", .fallback = 0.5, .min = 0, .min_open = true},
                {.name = "heave",
                 .type = Type::flag,
                 .doc = "true: vertical motion follows from weight and water pressure, without suction. false: `motion` also prescribes "
                        "the height, and the water adheres to the object.",
                 .fallback = true},
                {.name = "motion",
                 .type = Type::table,
                 .doc = "Prescribed motion in the plane, and along y where heave = false; at rest if absent.",
                 .selector = "kind",
                 .variants_from = &scene::motions}}};
}

std::unique_ptr<Solver> make(const scene::Scene& scene, const Partition& partition) {
    if (scene.text("scheme.model") == "columns") return std::make_unique<Columns>(scene, partition);
    if (!scene.root().tables("floats").empty())
        scene.refuse("floats", "the model \"shallow_water\" has no floating objects",
                     "use scheme.model = \"columns\"; solids stand on the bed");
    return std::make_unique<ShallowWater>(scene, partition);
}

/// Rejects keys of a scene that are not supported in parallel.
void check_parallel(const scene::Scene& scene) {
    if (scene.dim() == 3 && !scene.root().tables("floats").empty()) scene::one_process_only(scene, "floats", "floating objects are");
    scene::refuse_brush(scene);
}

}  // namespace

scene::SolverKind kind() {
    scene::SolverSchema schema;
    schema.name = "heightfield";
    schema.doc =
        "Water with one depth per column: long waves, floods, tides on dry ground; no overturning, no drops, no flow below the surface.";
    schema.keys = {grid_key(),
                   {.name = "time",
                    .type = Type::table,
                    .keys = {{.name = "cfl",
                              .type = Type::number,
                              .doc = "CFL number: part of a column that waves may cross in a step, summed over the axes.",
                              .fallback = 0.45}}},
                   scheme_keys(),
                   terrain_key(),
                   floats_key(),
                   initial_key(),
                   sides_key()};
    schema.columns = true;
    schema.effects = effect_schemas();
    schema.without = {"fluid.viscosity", "sides.*.temperature", "sides.*.smoke", "sides.*.profile", "sides.y_min", "sides.y_max",
                      "emitters",        "initial.temperature", "initial.smoke"};
    return {schema,
            make,
            {{"velocity", "depth", "surface", "bed"},
             {"move water"},
             "initial = { surface = \"0.5\", velocity = { name = \"formula\", x = \"0.1*sin(6*x)\" } }"},
            {.check = check_parallel, .distributed_storage = holds_own_rows, .partition = [](const scene::Scene& scene, int ranks) {
                 return partition_of_rows(Plane(scene), ranks);
             }}};
}

}  // namespace weir::heightfield
