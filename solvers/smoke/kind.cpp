// The schema of the solver "mac".
#include "mac/grid/kind.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/inflow.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/own_planes.hpp"
#include "scene/one_process.hpp"
#include "smoke/effects.hpp"
#include "smoke/solver.hpp"
#include "thermo/heat_keys.hpp"

namespace weir::smoke {

using scene::Key;
using scene::Type;

namespace {

/// Inflow profiles are those of mac/grid/inflow.hpp.
Key sides_key() {
    Key sides{.name = "sides", .type = Type::table};
    for (const char* axis : {"x", "y", "z"})
        for (const char* end : {"_min", "_max"}) {
            Key side{.name = std::string(axis) + end, .type = Type::table};
            side.variants = {{"inflow",
                              "",
                              {{.name = "profile",
                                .type = Type::choice,
                                .doc = "uniform; parabolic: the mean of 6 s (1 - s); kovasznay: the exact wake at Re = 1 / viscosity.",
                                .fallback = std::string("uniform"),
                                .choices = inflow_profiles()}}}};
            side.variants.push_back(thermo::wall_with_exchange());
            sides.keys.push_back(std::move(side));
        }
    return sides;
}

/// Rejects keys of a scene that are not supported in parallel.
void check_parallel(const scene::Scene& scene) {
    scene::refuse_bodies(scene);
    if (Heat<2>::named(scene)) scene::one_process_only(scene, "substance", "melting of a substance is");
    scene::refuse_brush(scene);
}

}  // namespace

scene::SolverKind kind() {
    scene::SolverSchema schema;
    schema.name = "mac";
    schema.doc = "Incompressible fluid that fills the domain, on a staggered grid: laminar flows, smoke, heat, moving obstacles.";
    std::vector<Key> methods = AdvectionOptions::keys();
    methods.push_back(PoissonChoice::key());
    schema.keys = {rigid::bodies_key(), rigid::joints_key(), rigid::probe_key(), scheme_key(std::move(methods)),
                   sides_key(),         initial_keys()};
    for (Key& key : Heat<2>::keys()) schema.keys.push_back(std::move(key));
    schema.effects = schemas_of(effect_kinds());
    schema.effects.push_back(geometry::brush_schema());
    return {schema,
            [](const scene::Scene& scene, const Partition& partition) { return make_without_surface<FlowSolver>(scene, partition); },
            {{"velocity", "pressure"}, {"ghosts", "advect velocity", "project"}, "initial.velocity = \"random\""},
            {.check = check_parallel, .replicated_work = mac::replicated_pressure, .distributed_storage = mac::holds_own_planes}};
}

}  // namespace weir::smoke
