#include "tallcell/kind.hpp"

#include "geometry/brush.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/kind.hpp"
#include "scene/one_process.hpp"
#include "scene/surface_keys.hpp"
#include "tallcell/solver.hpp"

namespace weir::tallcell {

using scene::Key;
using scene::Type;

const EffectKinds& body_forces() {
    static const EffectKinds kinds{gravity(), rotating_frame()};
    return kinds;
}

TallOptions::TallOptions(const scene::Scene& scene) {
    const auto& scheme = scene.root().table("scheme");
    const std::string& columns = scheme.text("columns");
    shape.division = columns == "uniform" ? Division::uniform : columns == "single" ? Division::single : Division::stacked;
    shape.depth = static_cast<int>(scheme.integer("layers"));
    maccormack = scheme.text("advection") == "maccormack";
    const auto& pressure = scheme.table("poisson");
    poisson.tolerance = pressure.number("tolerance");
    poisson.max_iterations = static_cast<int>(pressure.integer("max_iterations"));
    poisson.fixed_iterations = pressure.flag("fixed");
    cfl = scene.number("time.cfl");
    volume_control = scene.effect("volume_control") != nullptr;
}

namespace {

Key scheme_keys() {
    return scheme_key(
        {{.name = "columns",
          .type = Type::choice,
          .doc = "Cells below the regular cells of a column: one tall cell as in the paper, stacked ones whose height grows with depth, or "
                 "only regular cells (uniform).",
          .fallback = std::string("stacked"),
          .choices = {"stacked", "single", "uniform"}},
         {.name = "layers",
          .type = Type::integer,
          .doc = "Minimum number of rows of regular cells below the surface. A single tall cell represents waves up to four times as long.",
          .fallback = std::int64_t{8},
          .min = 8},
         {.name = "advection",
          .type = Type::choice,
          .doc = "Advection of velocity: semi-Lagrangian with or without MacCormack's correction.",
          .fallback = std::string("maccormack"),
          .choices = {"maccormack", "semi_lagrangian"}},
         {.name = "poisson",
          .type = Type::table,
          .doc = "Solver of the pressure equation: conjugate gradients with multigrid on columns.",
          .keys = {{.name = "tolerance",
                    .type = Type::number,
                    .doc = "Relative residual: residual over right-hand side.",
                    .fallback = 1e-8,
                    .min = 1e-15,
                    .max = 1},
                   {.name = "max_iterations",
                    .type = Type::integer,
                    .doc = "Maximum number of iterations; a solve that needs more fails.",
                    .fallback = std::int64_t{100},
                    .min = 1},
                   {.name = "fixed",
                    .type = Type::flag,
                    .doc = "Run exactly max_iterations, without a convergence test.",
                    .fallback = false}}}});
}

/// Rejects keys of a scene that are not supported in parallel.
void check_parallel(const scene::Scene& scene) { scene::refuse_brush(scene); }

}  // namespace

scene::SolverKind kind() {
    scene::SolverSchema schema;
    schema.name = "tallcell";
    schema.doc = "Liquid with a free surface on tall cells: regular cells near the surface, cells as tall as the water is deep below.";
    schema.dims = {2, 3};
    schema.whole_columns = true;
    schema.keys = {{.name = "time", .type = Type::table, .keys = {{.name = "cfl", .type = Type::number, .fallback = 1.0, .max = 3.0}}},
                   scheme_keys(),
                   initial_keys(),
                   scene::surface_key_of_level_set(false)};
    schema.effects = schemas_of(body_forces());
    schema.effects.push_back(free_surface::volume_control());
    schema.effects.push_back(geometry::brush_schema());
    schema.without = {"sides.*.temperature", "sides.*.smoke", "sides.*.profile", "emitters", "initial.temperature", "initial.smoke"};
    return {
        schema,
        [](const scene::Scene& scene, const Partition& partition) { return mac::make<TallCells>(scene, partition); },
        {{"velocity", "pressure", "level_set", "cell_height"},
         {"level set", "remesh", "advect", "walls", "project", "extrapolate"},
         "liquid = [ { shape = \"box\", min = <0.0>, max = <0.5> } ]\ninitial.velocity = \"random\""},
        {.check = check_parallel,
         .replicated_work =
             [](const scene::Scene&, const Partition&) {
                 return scene::ReplicatedWorks{scene::ReplicatedWork::small_pressure_levels, scene::ReplicatedWork::level_set_in_solids};
             },
         .distributed_storage = holds_own_planes,
         .partition = partition_of_columns}};
}

}  // namespace weir::tallcell
