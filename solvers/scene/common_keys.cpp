// Schema of the keys common to all scenes. Units are SI. Nothing is enabled by default.
#include "scene/frame_formats.hpp"
#include "scene/schema.hpp"

namespace weir::scene {
namespace {

const std::vector<Variant>& field_shapes() {
    static const std::vector<Variant> list = {
        {"constant", "The same value everywhere.", {{.name = "value", .type = Type::number, .doc = "The value.", .required = true}}},
        {"linear",
         "value + gradient . (x - at)",
         {{.name = "value", .type = Type::number, .doc = "The value at `at`.", .fallback = 0.0},
          {.name = "gradient", .type = Type::numbers, .doc = "Gradient along each axis.", .unit = "1/m", .required = true, .length = -1},
          {.name = "at",
           .type = Type::numbers,
           .doc = "Point at which it has `value`.",
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
    return {
        .name = "grid",
        .type = Type::table,
        .doc = "The box of cells in which the fluid is simulated.",
        .required = true,
        .keys = {{.name = "cells",
                  .type = Type::integers,
                  .doc = "Number of cells along each axis. Cells need not be cubes, except for particles, whose spacing is the cell width.",
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
            .doc = "End time and time steps.",
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
                      .doc = "CFL number: cells that the fastest fluid may cross in one step, where `dt` is not given.",
                      .fallback = 0.5,
                      .min = 0,
                      .min_open = true,
                      .steerable = true},
                     {.name = "dt",
                      .type = Type::number,
                      .doc = "A fixed time step, instead of one from `cfl`.",
                      .unit = "s",
                      .min = 0,
                      .min_open = true,
                      .steerable = true},
                     {.name = "max_dt",
                      .type = Type::number,
                      .doc = "Upper bound of the time step.",
                      .unit = "s",
                      .min = 0,
                      .min_open = true,
                      .steerable = true},
                     {.name = "stop_when_steady",
                      .type = Type::number,
                      .doc = "End the run after the first step in which no component of the velocity on the grid changed faster than this. "
                             "A flow before a later event (an emitter, a change) also counts as steady.",
                      .unit = "m/s^2",
                      .min = 0,
                      .min_open = true},
                     {.name = "guard",
                      .type = Type::choice,
                      .doc = "Treatment of a step, from `dt` or `cfl`, that exceeds the stability limit of the solver. substep: it is "
                             "divided into equal substeps, with one warning; off: it is taken, for studies of stability limits.",
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
                 .doc = "Kinematic viscosity. It acts only if effects.viscosity is named.",
                 .unit = "m^2/s",
                 .fallback = 0.0,
                 .min = 0,
                 .steerable = true}}};
}

Key side_temperature(std::string doc) { return {.name = "temperature", .type = Type::number, .doc = std::move(doc), .unit = "K"}; }

const std::vector<Variant>& side_kinds() {
    static const std::vector<Variant> list = {
        {"wall",
         "Solid wall.",
         {{.name = "slip",
           .type = Type::choice,
           .doc = "Boundary condition of the tangential velocity: free slip or no slip.",
           .fallback = std::string("free"),
           .choices = {"free", "no"}},
          side_temperature("Temperature of the wall; without it the wall is adiabatic.")}},
        {"moving_wall",
         "A wall that moves tangentially, with no slip.",
         {{.name = "velocity",
           .type = Type::numbers,
           .doc = "Tangential velocity of the wall.",
           .unit = "m/s",
           .required = true,
           .length = -1},
          side_temperature("Temperature of the wall; without it the wall is adiabatic.")}},
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
        {"outflow", "Open: the pressure is 0 and fluid flows in and out.", {side_temperature("Temperature of fluid that comes in.")}},
        {"open", "Alias of outflow.", {side_temperature("Temperature of fluid that comes in.")}},
        {"periodic", "Periodic: fluid that leaves here enters at the opposite side, which must also be periodic.", {}},
    };
    return list;
}

Key sides() {
    Key key{
        .name = "sides", .type = Type::table, .doc = "Boundary condition at each side of the domain. A side that is not given is a wall."};
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
                      .doc = "Boundary condition of the tangential velocity: free slip or no slip.",
                      .fallback = std::string("free"),
                      .choices = {"free", "no"}},
                     {.name = "motion",
                      .type = Type::table,
                      .doc = "Prescribed motion; without it the body is at rest.",
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
                     {.name = "start", .type = Type::number, .doc = "Start time.", .unit = "s", .fallback = 0.0, .min = 0},
                     {.name = "end", .type = Type::number, .doc = "End time; unlimited if absent.", .unit = "s", .min = 0}},
            .selector = "shape",
            .variants_from = &shapes};
}

Key initial() {
    Key velocity = initial_field("velocity", "Velocity at t = 0; at rest if absent.", "m/s");
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
         "On a line along an axis: the height of the uppermost liquid (also of a drop) above the domain's lower side, and the depth, the "
         "length of the line in liquid.",
         {probe_point("at", "Any point of the line."),
          {.name = "axis", .type = Type::choice, .doc = "The line's axis.", .fallback = std::string("y"), .choices = {"x", "y", "z"}}}},
        {"wall_pressure",
         "Pressure on a wall or solid, at its point nearest to `at`: on grids fitted to the cells of liquid beside it; of particles their "
         "force "
         "per area, over two spacings around the point.",
         {probe_point("at", "The point.")}},
        {"integral", "A field summed over the fluid.", {probed_field()}},
        {"front",
         "Extent of the liquid along an axis.",
         {{.name = "axis", .type = Type::choice, .doc = "The axis.", .fallback = std::string("x"), .choices = {"x", "y", "z"}}}},
    };
    return list;
}

Key probes() {
    return {.name = "probes",
            .type = Type::tables,
            .doc = "Measurements written to CSV files, one per probe.",
            .keys = {{.name = "name", .type = Type::text, .doc = "Name of the CSV file.", .required = true, .example = "name = \"front\""},
                     {.name = "every",
                      .type = Type::number,
                      .doc = "Interval of measurements (0, every, 2 every, ...), interpolated linearly in time between steps; after each "
                             "step if absent.",
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
                "Keys that change during the run, in the order of time. Steps end exactly at these times; a change is equivalent to a "
                "restart from a checkpoint with another --set. The keys that may change are marked.",
            .keys = {{.name = "time", .type = Type::number, .doc = "When.", .unit = "s", .required = true, .min = 0},
                     {.name = "key", .type = Type::text, .doc = "Name of the key, such as \"effects.gravity.g\".", .required = true},
                     {.name = "value", .type = Type::any, .doc = "New value of the key.", .required = true}}};
}

Key output() {
    return {.name = "output",
            .type = Type::table,
            .doc = "Frames and their contents.",
            .keys = {{.name = "every",
                      .type = Type::number,
                      .doc = "Interval between frames; only the first and the last if absent.",
                      .unit = "s",
                      .min = 0,
                      .min_open = true},
                     {.name = "at",
                      .type = Type::choice,
                      .doc = "step: a frame is the state after the first step that reaches its time, and the series has that step's time; "
                             "the solution does not depend on `every`. exact: steps are shortened so that frames have exactly the "
                             "times k every; the solution then depends on `every`.",
                      .fallback = std::string("step"),
                      .choices = {"step", "exact"}},
                     {.name = "format",
                      .type = Type::choice,
                      .doc = "File format of frames. `weir view`, `weir picture` and `weir movie` read vtk (.vti, .vtp and a .pvd series).",
                      .fallback = frame_formats().front(),
                      .choices = frame_formats()},
                     {.name = "fields",
                      .type = Type::texts,
                      .doc = "Fields to write; all fields of the solver if empty.",
                      .fallback = std::vector<std::string>{}},
                     {.name = "faces", .type = Type::flag, .doc = "Also write the face components of the velocity.", .fallback = false},
                     {.name = "precision",
                      .type = Type::choice,
                      .doc = "Precision of values in frames; checkpoints are always exact.",
                      .fallback = std::string("double"),
                      .choices = {"double", "single"}},
                     {.name = "compression",
                      .type = Type::choice,
                      .doc = "Compression of frames: zlib is read by all programs, lz4 is faster.",
                      .fallback = std::string("zlib"),
                      .choices = {"zlib", "lz4", "none"}}}};
}

}  // namespace

const std::vector<Key>& common_keys() {
    static const std::vector<Key> list = {
        {.name = "title", .type = Type::text, .doc = "One-line description.", .fallback = std::string()},
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
         .doc = "Regions of liquid at t = 0, for solvers with a free surface.",
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
