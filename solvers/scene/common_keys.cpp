// Schema of the keys common to all scenes. Units are SI. Nothing is enabled by default.
#include "scene/schema.hpp"

namespace weir::scene {
namespace {

const std::vector<Variant>& field_shapes() {
    static const std::vector<Variant> list = {
        {"constant", "The same value everywhere.", {{.name = "value", .type = Type::number, .doc = "The value.", .required = true}}},
        {"linear",
         "value + gradient . (x - at)",
         {{.name = "value", .type = Type::number, .doc = "The value at `at`.", .fallback = 0.0},
          {.name = "gradient",
           .type = Type::numbers,
           .doc = "Change a metre along each axis.",
           .unit = "1/m",
           .required = true,
           .length = -1},
          {.name = "at",
           .type = Type::numbers,
           .doc = "Where it has `value`.",
           .unit = "m",
           .fallback = std::vector<double>{0},
           .length = -1}}},
        {"gaussian",
         "base + amplitude exp(-|x - centre|^2 / (2 width^2))",
         {{.name = "base", .type = Type::number, .doc = "The value far away.", .fallback = 0.0},
          {.name = "amplitude", .type = Type::number, .doc = "Height of the hill.", .fallback = 1.0},
          {.name = "centre", .type = Type::numbers, .doc = "Its top.", .unit = "m", .required = true, .length = -1},
          {.name = "width",
           .type = Type::number,
           .doc = "Its standard deviation.",
           .unit = "m",
           .required = true,
           .min = 0,
           .min_open = true}}},
    };
    return list;
}

Key initial_field(std::string name, std::string doc, std::string unit) {
    return {.name = std::move(name),
            .type = Type::table,
            .doc = std::move(doc),
            .unit = std::move(unit),
            .selector = "name",
            .variants_from = &field_shapes};
}

Key grid() {
    return {.name = "grid",
            .type = Type::table,
            .doc = "The box of cells in which the fluid is simulated.",
            .required = true,
            .keys = {{.name = "cells",
                      .type = Type::integers,
                      .doc = "Number of cells along each axis. They need not be cubes, but for particles, whose spacing is their width.",
                      .required = true,
                      .min = 1,
                      .length = -1,
                      .example = "cells = [64, 64]"},
                     {.name = "size",
                      .type = Type::numbers,
                      .doc = "Extent along each axis.",
                      .unit = "m",
                      .required = true,
                      .min = 0,
                      .min_open = true,
                      .length = -1,
                      .example = "size = [1.0, 1.0]"},
                     {.name = "origin",
                      .type = Type::numbers,
                      .doc = "Lower corner.",
                      .unit = "m",
                      .fallback = std::vector<double>{0},
                      .length = -1},
                     {.name = "periodic",
                      .type = Type::texts,
                      .doc = "Axes along which the domain repeats; the same as kind = \"periodic\" on both sides.",
                      .fallback = std::vector<std::string>{},
                      .choices = {"x", "y", "z"}}},
            .example = "grid = { cells = [64, 64], size = [1.0, 1.0] }"};
}

Key time() {
    return {.name = "time",
            .type = Type::table,
            .doc = "How long, and in which steps.",
            .required = true,
            .keys = {{.name = "end",
                      .type = Type::number,
                      .doc = "The run starts at 0 and ends here.",
                      .unit = "s",
                      .required = true,
                      .min = 0,
                      .min_open = true,
                      .example = "end = 1.0",
                      .steerable = true},
                     {.name = "cfl",
                      .type = Type::number,
                      .doc = "How many cells the fastest fluid may cross in one step, where `dt` is not given.",
                      .fallback = 0.5,
                      .min = 0,
                      .min_open = true,
                      .steerable = true},
                     {.name = "dt",
                      .type = Type::number,
                      .doc = "A fixed step, in place of one from `cfl`.",
                      .unit = "s",
                      .min = 0,
                      .min_open = true,
                      .steerable = true},
                     {.name = "max_dt",
                      .type = Type::number,
                      .doc = "No step is longer.",
                      .unit = "s",
                      .min = 0,
                      .min_open = true,
                      .steerable = true},
                     {.name = "stop_when_steady",
                      .type = Type::number,
                      .doc = "End the run after the first step in which no component of the velocity on the grid changed faster than this. "
                             "A flow that still waits for something to begin is steady too.",
                      .unit = "m/s^2",
                      .min = 0,
                      .min_open = true},
                     {.name = "guard",
                      .type = Type::choice,
                      .doc = "What happens to a step, from `dt` or `cfl`, that is longer than the solver is stable for. substep: it is "
                             "taken in equal parts, and said so once; off: it is taken, for studies of where a method breaks.",
                      .fallback = std::string("substep"),
                      .choices = {"substep", "off"}}},
            .example = "time = { end = 1.0 }"};
}

Key fluid() {
    return {.name = "fluid",
            .type = Type::table,
            .doc = "Properties of the fluid.",
            .keys = {
                {.name = "density", .type = Type::number, .doc = "Density.", .unit = "kg/m^3", .fallback = 1.0, .min = 0, .min_open = true},
                {.name = "viscosity",
                 .type = Type::number,
                 .doc = "Kinematic viscosity. It acts only where effects.viscosity is named.",
                 .unit = "m^2/s",
                 .fallback = 0.0,
                 .min = 0,
                 .steerable = true}}};
}

Key side_temperature(std::string doc) { return {.name = "temperature", .type = Type::number, .doc = std::move(doc), .unit = "K"}; }

const std::vector<Variant>& side_kinds() {
    static const std::vector<Variant> list = {
        {"wall",
         "Nothing passes.",
         {{.name = "slip",
           .type = Type::choice,
           .doc = "free: fluid glides along the wall; no: it sticks to it.",
           .fallback = std::string("free"),
           .choices = {"free", "no"}},
          side_temperature("Temperature of the wall; without it no heat passes.")}},
        {"moving_wall",
         "A wall that moves along itself; fluid sticks to it.",
         {{.name = "velocity",
           .type = Type::numbers,
           .doc = "Velocity of the wall, along it.",
           .unit = "m/s",
           .required = true,
           .length = -1},
          side_temperature("Temperature of the wall; without it no heat passes.")}},
        {"inflow",
         "Fluid enters with a given velocity.",
         {{.name = "velocity",
           .type = Type::numbers,
           .doc = "Velocity; of a parabolic profile, its mean.",
           .unit = "m/s",
           .required = true,
           .length = -1},
          {.name = "profile",
           .type = Type::text,
           .doc = "uniform, parabolic (zero at the neighbouring walls), or a velocity field that the solver knows by name.",
           .fallback = std::string("uniform")},
          {.name = "smoke", .type = Type::number, .doc = "Smoke in the entering fluid.", .min = 0},
          side_temperature("Temperature of the entering fluid.")}},
        {"outflow", "Open: the pressure is 0 and fluid passes both ways.", {side_temperature("Temperature of fluid that comes in.")}},
        {"open", "Another word for outflow.", {side_temperature("Temperature of fluid that comes in.")}},
        {"periodic", "What leaves here enters at the opposite side, which must be periodic too.", {}},
    };
    return list;
}

Key sides() {
    Key key{.name = "sides", .type = Type::table, .doc = "What stands at each side of the domain. A side that is not given is a wall."};
    for (const std::string axis : {"x", "y", "z"})
        for (const std::string end : {"min", "max"})
            key.keys.push_back({.name = axis + "_" + end,
                                .type = Type::table,
                                .doc = "The " + std::string(end == "min" ? "lower" : "upper") + " side along " + axis + ".",
                                .fallback = std::string("wall"),
                                .selector = "kind",
                                .variants_from = &side_kinds,
                                .only_dim = axis == "z" ? 3 : 0});
    return key;
}

Key solids() {
    return {.name = "solids",
            .type = Type::tables,
            .doc = "Bodies that fluid cannot enter.",
            .keys = {{.name = "slip",
                      .type = Type::choice,
                      .doc = "free: fluid glides along the body; no: it sticks to it.",
                      .fallback = std::string("free"),
                      .choices = {"free", "no"}},
                     {.name = "motion",
                      .type = Type::table,
                      .doc = "Prescribed motion; without it the body rests.",
                      .selector = "kind",
                      .variants_from = &motions}},
            .selector = "shape",
            .variants_from = &shapes};
}

Key emitters() {
    return {.name = "emitters",
            .type = Type::tables,
            .doc = "Regions that add fluid, smoke or heat.",
            .keys = {{.name = "velocity", .type = Type::numbers, .doc = "Velocity set inside.", .unit = "m/s", .length = -1},
                     {.name = "smoke", .type = Type::number, .doc = "Smoke set inside.", .min = 0},
                     {.name = "temperature", .type = Type::number, .doc = "Temperature set inside.", .unit = "K"},
                     {.name = "start", .type = Type::number, .doc = "It works from here on.", .unit = "s", .fallback = 0.0, .min = 0},
                     {.name = "end", .type = Type::number, .doc = "It works until here; for ever where absent.", .unit = "s", .min = 0}},
            .selector = "shape",
            .variants_from = &shapes};
}

Key initial() {
    Key velocity = initial_field("velocity", "Velocity at t = 0; rest where absent.", "m/s");
    velocity.variants_from = nullptr;
    velocity.variants = {
        {"constant",
         "The same velocity everywhere.",
         {{.name = "value", .type = Type::numbers, .doc = "The velocity.", .unit = "m/s", .required = true, .length = -1}}}};
    return {.name = "initial",
            .type = Type::table,
            .doc = "Fields at t = 0, each a function by name.",
            .keys = {velocity, initial_field("temperature", "Temperature at t = 0.", "K"), initial_field("smoke", "Smoke at t = 0.", "")}};
}

Key probed_field() { return {.name = "field", .type = Type::text, .doc = "Name of the field, such as \"pressure\".", .required = true}; }

Key probe_point(std::string name, std::string doc) {
    return {.name = std::move(name), .type = Type::numbers, .doc = std::move(doc), .unit = "m", .required = true, .length = -1};
}

const std::vector<Variant>& probe_kinds() {
    static const std::vector<Variant> list = {
        {"point", "A field at one point; nan while a solid that moves covers it.", {probed_field(), probe_point("at", "The point.")}},
        {"line",
         "A field at points along a line; nan where a solid covers one.",
         {probed_field(),
          probe_point("from", "First point."),
          probe_point("to", "Last point."),
          {.name = "count", .type = Type::integer, .doc = "Number of points.", .fallback = std::int64_t{64}, .min = 2, .max = 1e6}}},
        {"gauge",
         "On a line along an axis: the height of the uppermost liquid above the domain's lower side, be it a drop, and the depth, how much "
         "of the line lies in liquid.",
         {probe_point("at", "Any point of the line."),
          {.name = "axis", .type = Type::choice, .doc = "The line's axis.", .fallback = std::string("y"), .choices = {"x", "y", "z"}}}},
        {"wall_pressure",
         "Pressure on a wall or solid, at its point nearest to `at`: on grids fitted to the cells of liquid beside it; of particles their "
         "force "
         "per area, over two spacings around the point.",
         {probe_point("at", "The point.")}},
        {"integral", "A field summed over the fluid.", {probed_field()}},
        {"front",
         "How far the liquid reaches along an axis.",
         {{.name = "axis", .type = Type::choice, .doc = "The axis.", .fallback = std::string("x"), .choices = {"x", "y", "z"}}}},
    };
    return list;
}

Key probes() {
    return {.name = "probes",
            .type = Type::tables,
            .doc = "Measurements written to CSV files, one a probe.",
            .keys = {{.name = "name", .type = Type::text, .doc = "Name of the CSV file.", .required = true, .example = "name = \"front\""},
                     {.name = "every",
                      .type = Type::number,
                      .doc = "Measurements at 0, every, 2 every, ..., linear in time between the steps before and after; after each step "
                             "where absent.",
                      .unit = "s",
                      .min = 0,
                      .min_open = true}},
            .selector = "kind",
            .variants_from = &probe_kinds};
}

Key changes() {
    return {.name = "changes",
            .type = Type::tables,
            .doc =
                "Keys that change while the run goes on, in the order of time. Steps meet these times exactly; a change is the same as "
                "going on from a checkpoint with another --set. Keys that may are marked so.",
            .keys = {{.name = "time", .type = Type::number, .doc = "When.", .unit = "s", .required = true, .min = 0},
                     {.name = "key", .type = Type::text, .doc = "Which, such as \"effects.gravity.g\".", .required = true},
                     {.name = "value", .type = Type::any, .doc = "What that key takes.", .required = true}}};
}

Key output() {
    return {.name = "output",
            .type = Type::table,
            .doc = "Which frames are written, and what is in them.",
            .keys = {{.name = "every",
                      .type = Type::number,
                      .doc = "Interval between frames; only the first and the last where absent.",
                      .unit = "s",
                      .min = 0,
                      .min_open = true},
                     {.name = "at",
                      .type = Type::choice,
                      .doc = "step: a frame is the state after the first step that reaches its time, and the series (.pvd) has that step's "
                             "time; the solution does not depend on `every`. exact: steps are shortened so that frames have exactly the "
                             "times k every; the solution then depends on `every`.",
                      .fallback = std::string("step"),
                      .choices = {"step", "exact"}},
                     {.name = "fields",
                      .type = Type::texts,
                      .doc = "Fields to write; all that the solver has where empty.",
                      .fallback = std::vector<std::string>{}},
                     {.name = "faces", .type = Type::flag, .doc = "Write the face components of the velocity too.", .fallback = false},
                     {.name = "precision",
                      .type = Type::choice,
                      .doc = "Of the numbers in frames; checkpoints are always exact.",
                      .fallback = std::string("double"),
                      .choices = {"double", "single"}},
                     {.name = "compression",
                      .type = Type::choice,
                      .doc = "Of frames: zlib is understood everywhere, lz4 is faster.",
                      .fallback = std::string("zlib"),
                      .choices = {"zlib", "lz4", "none"}}}};
}

}  // namespace

const std::vector<Key>& common_keys() {
    static const std::vector<Key> list = {
        {.name = "title", .type = Type::text, .doc = "One line for people.", .fallback = std::string()},
        {.name = "solver",
         .type = Type::text,
         .doc = "Name of the solver; see `weir list solvers`.",
         .required = true,
         .example = "solver = \"mac\""},
        {.name = "dim", .type = Type::integer, .doc = "2 or 3 dimensions.", .required = true, .min = 2, .max = 3, .example = "dim = 2"},
        grid(),
        time(),
        fluid(),
        sides(),
        {.name = "liquid",
         .type = Type::tables,
         .doc = "Where there is liquid at t = 0, for solvers with a free surface.",
         .selector = "shape",
         .variants_from = &shapes},
        solids(),
        emitters(),
        initial(),
        probes(),
        changes(),
        output(),
    };
    return list;
}

}  // namespace weir::scene
