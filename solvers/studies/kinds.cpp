#include "studies/kinds.hpp"

#include "mac/grid/initial.hpp"
#include "mac/grid/kind.hpp"
#include "scene/surface_keys.hpp"
#include "studies/closed_vessel.hpp"
#include "studies/phase_diagram.hpp"
#include "studies/poisson_problem.hpp"
#include "studies/reconstruction_study.hpp"
#include "studies/transport.hpp"
#include "thermo/scene_substance.hpp"

namespace weir::studies {

using scene::Key;
using scene::Type;

scene::SolverKind transport_kind() {
    scene::SolverSchema schema;
    schema.name = "transport";
    schema.study = true;
    schema.doc = "Cell fields carried by a prescribed velocity, to measure advection schemes.";
    schema.keys = {scheme_key(AdvectionOptions::keys()), PrescribedFlow<2>::key(), initial_keys({"level_set", "tracer"})};
    schema.without = {"time.stop_when_steady", "fluid", "solids", "emitters", "initial.velocity"};
    return {schema, [](const scene::Scene& scene, const Partition&) { return make_without_surface<TransportSolver>(scene); }};
}

scene::SolverKind poisson_kind() {
    Key problem{
        .name = "problem", .type = Type::choice, .doc = "Manufactured right-hand side: N no-flux sides, D zero sides.", .required = true};
    for (const auto& known : manufactured_problems()) problem.choices.push_back(known.name);
    problem.example = "problem = \"N1\"";
    scene::SolverSchema schema;
    schema.name = "poisson";
    schema.study = true;
    schema.doc = "One manufactured pressure problem on the unit square or cube, solved in one step.";
    schema.keys = {scheme_key({PoissonChoice::key()}), problem};
    schema.without = {"time.stop_when_steady", "grid.periodic", "time.cfl", "fluid", "sides", "solids", "emitters", "initial"};
    return {schema, [](const scene::Scene& scene, const Partition&) { return make_without_surface<PoissonProblemSolver>(scene); }};
}

scene::SolverKind phase_diagram_kind() {
    scene::SolverSchema schema;
    schema.name = "phase_diagram";
    schema.study = true;
    schema.doc = "A substance in the plane of temperature (x, in K) and pressure (y, its decimal logarithm, in Pa), without any flow.";
    schema.dims = {2};
    schema.keys = {thermo::substance_key(), PhaseDiagram::samples_key()};
    schema.without = {"time.stop_when_steady", "grid.periodic", "time.cfl", "fluid", "sides", "liquid", "solids", "emitters", "initial"};
    return {schema, [](const scene::Scene& scene, const Partition&) { return std::make_unique<PhaseDiagram>(scene); }};
}

scene::SolverKind reconstruction_kind() {
    Key output = scene::surface_key_of_particles();
    output.keys[0].required = true;
    output.keys[0].example = "output.surface = \"zhu_bridson\"";
    scene::SolverSchema schema;
    schema.name = "reconstruction";
    schema.study = true;
    schema.doc = "Particles at rest on a lattice, and their surface: to measure surface reconstruction.";
    schema.dims = {2, 3};
    schema.keys = {output, ReconstructionStudy::jitter_key()};
    schema.without = {
        "time.stop_when_steady", "grid.periodic", "time.cfl", "fluid", "sides", "solids", "emitters", "initial", "probes", "changes"};
    return {schema, [](const scene::Scene& scene, const Partition&) { return std::make_unique<ReconstructionStudy>(scene); }};
}

scene::SolverKind closed_vessel_kind() {
    scene::SolverSchema schema;
    schema.name = "closed_vessel";
    schema.study = true;
    schema.doc = "Water and its vapour in a rigid vessel, without flow: the gas has one pressure, and comes to that of saturation.";
    schema.dims = {2};
    schema.keys = ClosedVessel::keys();
    schema.without = {"time.stop_when_steady", "grid.periodic", "time.cfl", "fluid", "sides", "liquid", "solids", "emitters", "initial"};
    return {schema, [](const scene::Scene& scene, const Partition&) { return std::make_unique<ClosedVessel>(scene); }};
}

}  // namespace weir::studies
