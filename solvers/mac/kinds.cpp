#include "mac/kinds.hpp"

#include "mac/effects.hpp"
#include "mac/inflow.hpp"
#include "mac/initial.hpp"
#include "mac/poisson_solver.hpp"
#include "mac/smoke_solver.hpp"
#include "mac/transport_solver.hpp"

namespace weir::mac {

namespace {

using scene::Key;
using scene::Type;

/// Makes the solver of the scene's dimension. These solvers have no free surface, so liquid in a part of the domain is a mistake.
template <template <int> class S>
std::unique_ptr<Solver> make(const scene::Scene& scene) {
    if (!scene.root().tables("liquid").empty())
        scene.refuse("liquid", "solver \"" + scene.solver() + "\" has no free surface and no use for liquid",
                     "solver \"mac_water\" has one");
    if (scene.dim() == 2) return std::make_unique<S<2>>(scene);
    return std::make_unique<S<3>>(scene);
}

Key scheme_key(std::vector<Key> keys) {
    return {.name = "scheme", .type = Type::table, .doc = "Numerical methods, by name.", .keys = std::move(keys)};
}

std::vector<Key> with_poisson(std::vector<Key> keys) {
    keys.push_back(PoissonChoice::key());
    return keys;
}

/// Inflow profiles are the names that this folder knows.
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
            sides.keys.push_back(std::move(side));
        }
    return sides;
}

}  // namespace

scene::SolverKind smoke_kind() {
    scene::SolverSchema schema;
    schema.name = "mac";
    schema.doc = "Incompressible fluid that fills the domain, on a staggered grid: laminar flows, smoke, heat, moving obstacles.";
    schema.keys = {scheme_key(with_poisson(AdvectionOptions::keys())), sides_key(), initial_keys()};
    for (const auto& kind : effect_kinds()) schema.effects.push_back(kind.schema);
    return {
        schema, make<SmokeSolver>, {{"velocity", "pressure"}, {"ghosts", "advect velocity", "project"}, "initial.velocity = \"random\""}};
}

scene::SolverKind transport_kind() {
    scene::SolverSchema schema;
    schema.name = "transport";
    schema.doc = "Cell fields carried by a prescribed velocity, to measure advection schemes.";
    schema.keys = {scheme_key(AdvectionOptions::keys()), PrescribedFlow<2>::key(), initial_keys({"level_set", "tracer"})};
    return {schema, make<TransportSolver>};
}

scene::SolverKind poisson_kind() {
    Key problem{
        .name = "problem", .type = Type::choice, .doc = "Manufactured right-hand side: N no-flux sides, D zero sides.", .required = true};
    for (const auto& known : manufactured_problems()) problem.choices.push_back(known.name);
    problem.example = "problem = \"N1\"";
    scene::SolverSchema schema;
    schema.name = "poisson";
    schema.doc = "One manufactured pressure problem on the unit square or cube, solved in one step.";
    schema.keys = {scheme_key(with_poisson({})), problem};
    return {schema, make<PoissonProblemSolver>};
}

}  // namespace weir::mac
