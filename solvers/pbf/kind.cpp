// The registration of "pbf": its keys, effects and factory.
#include "particles/state/kind.hpp"
#include "pbf/device_solver.hpp"
#include "pbf/reference_solver.hpp"
#include "pbf/solver.hpp"

namespace weir::pbf {

using scene::Key;
using scene::Type;

namespace {

Key scheme() {
    const Options usual;
    return particles::scheme_key(
        "Numerical choices of PBF.",
        "cubic and wendland: one kernel for the density and its gradient. muller: poly6 for density, spiky for its gradient, as published; "
        "a force that is not a gradient, so it adds energy.",
        usual,
        {{.name = "iterations",
          .type = Type::integer,
          .doc = "Iterations per step, if no tolerance is given.",
          .fallback = std::int64_t{usual.iterations},
          .min = 1,
          .steerable = true},
         {.name = "tolerance",
          .type = Type::number,
          .doc = "Iterate until the mean compression is at most this; 0: a fixed number of iterations.",
          .fallback = usual.tolerance,
          .min = 0,
          .steerable = true},
         {.name = "max_iterations",
          .type = Type::integer,
          .doc = "With a tolerance: maximum number of iterations.",
          .fallback = std::int64_t{usual.max_iterations},
          .min = 1,
          .steerable = true},
         {.name = "cfm",
          .type = Type::number,
          .doc = "Constraint force mixing, epsilon of eq. 11 in units of 1 / support^2.",
          .fallback = usual.cfm,
          .min = 0,
          .steerable = true},
         {.name = "relaxation",
          .type = Type::number,
          .doc = "Relaxation factor of every correction.",
          .fallback = usual.relaxation,
          .min = 0,
          .max = 2.0,
          .min_open = true,
          .steerable = true},
         {.name = "warm_start",
          .type = Type::number,
          .doc = "Warm start: the next step's iterations start from this fraction of the constraints' multipliers, which multiplies the "
                 "remaining compression by 1 - warm_start. From 0.5 on a liquid at rest oscillates.",
          .fallback = usual.warm_start,
          .min = 0,
          .max = 1.0,
          .steerable = true},
         {.name = "settle",
          .type = Type::integer,
          .doc = "Maximum number of iterations before the first step that remove the density error of the initial lattice from the "
                 "positions, so that it does not turn into velocity.",
          .fallback = std::int64_t{usual.settle},
          .min = 0}});
}

std::vector<scene::Variant> effects() {
    const Options usual;
    return {
        {"artificial_pressure",
         "Artificial pressure against clustering (Macklin & Müller 2013, eq. 13 with n = 4).",
         {{.name = "k", .type = Type::number, .doc = "Strength over the support squared.", .fallback = 1e-4, .min = 0, .steerable = true},
          {.name = "dq",
           .type = Type::number,
           .doc = "Distance, over the support, at which it has this strength.",
           .fallback = usual.pressure_dq,
           .min = 0,
           .max = 0.9}},
         {"k"}}};
}

}  // namespace

scene::SolverKind kind() {
    const char* doc = "Position Based Fluids (Macklin & Müller 2013): liquid particles kept at rest density by constraints.";
    return {particles::schema_of({.name = "pbf", .doc = doc, .keys = {scheme()}, .effects = effects(), .without = {"fluid.viscosity"}}, {}),
            particles::make_solver<PbfSolver, ReferencePbfSolver, DevicePbfSolver>,
            particles::plain_step({}, {"predict", "neighbours", "warm start", "lambda", "correct", "update"}),
            {.check = particles::refuse_in_parallel, .shared = scene::Shared::by_particles}};
}

}  // namespace weir::pbf
