// The registration of "sph": its keys, effects and factory.
#include "particles/state/kind.hpp"
#include "sph/device_solver.hpp"
#include "sph/reference_solver.hpp"
#include "sph/solver.hpp"

namespace weir::sph {

using scene::Key;
using scene::Type;

namespace {

Key scheme() {
    const Options usual;
    return particles::scheme_key(
        "Numerical choices of SPH.",
        "wendland and cubic: one kernel for all terms, so that forces between particles are the gradient of an energy. muller: as "
        "published in 2003, poly6 for density, spiky for pressure, its own for viscosity; these have no common energy and add energy to a "
        "liquid at rest, so they require viscosity.",
        usual,
        {{.name = "sound_speed",
          .type = Type::number,
          .doc = "Speed of sound; if absent: ten times the fastest flow that can be estimated before the start, which keeps density within "
                 "1%: a fall from the highest liquid to the bottom of the domain, initial velocities, emitters, moving walls and solids "
                 "(10 m/s where there are none).",
          .unit = "m/s",
          .min = 0,
          .min_open = true},
         {.name = "state",
          .type = Type::choice,
          .doc = "Equation of state. linear: p = c^2 (rho - rho0); tait: c^2 rho0 / gamma ((rho / rho0)^gamma - 1).",
          .fallback = std::string("linear"),
          .choices = {"linear", "tait"}},
         {.name = "gamma", .type = Type::number, .doc = "Exponent of Tait's equation.", .fallback = 7.0, .min = 1.0},
         {.name = "density",
          .type = Type::choice,
          .doc = "summation: of the kernel over neighbours (Müller et al. 2003), which underestimates density at a free surface. "
                 "continuity: the continuity equation, without that deficit. delta: continuity with the diffusion of density (delta = 0.1) "
                 "and the artificial viscosity (alpha = 0.02) of delta-SPH (Marrone et al. 2011), without which pressure waves in a column "
                 "at rest persist; the effects of these names set other values.",
          .fallback = std::string("delta"),
          .choices = {"delta", "continuity", "summation"}},
         {.name = "tension", .type = Type::flag, .doc = "Whether pressure may be negative.", .fallback = usual.tension}});
}

std::vector<scene::Variant> effects() {
    std::vector<scene::Variant> list;
    list.push_back({"viscosity",
                    "Viscous forces with fluid.viscosity (Müller et al. 2003, eq. 14; with the other kernels Morris et al. 1997), and at "
                    "walls and solids with slip = \"no\".",
                    {},
                    {"fluid.viscosity"}});
    list.push_back(
        {"density_diffusion",
         "Diffusion of density, without its hydrostatic part (delta-SPH: Molteni & Colagrossi 2009; Fourtakas et al. 2019).",
         {{.name = "delta", .type = Type::number, .doc = "Its strength.", .fallback = 0.1, .min = 0, .max = 1, .steerable = true}},
         {"delta"},
         "scheme.density = \"continuity\""});
    list.push_back(
        {"surface_tension",
         "Stress of the colour's gradient (Müller et al. 2003, eq. 15; Lafaurie et al. 1994); keeps momentum.",
         {{.name = "sigma", .type = Type::number, .doc = "Surface tension.", .unit = "N/m", .required = true, .min = 0, .steerable = true}},
         {"sigma"},
         "scheme.tension = true"});
    list.push_back({"artificial_viscosity",
                    "Viscosity of approaching pairs only (Monaghan 1992).",
                    {{.name = "alpha", .type = Type::number, .doc = "Its strength.", .fallback = 0.05, .min = 0, .steerable = true}},
                    {"alpha"},
                    "scheme.density = \"continuity\""});
    list.push_back({"rest_density",
                    "Rest density over time: where it is lowered, the liquid becomes a gas that fills its container.",
                    {{.name = "times", .type = Type::numbers, .doc = "When.", .unit = "s", .required = true, .example = "times = [0.0]"},
                     {.name = "values",
                      .type = Type::numbers,
                      .doc = "Values; linear in between.",
                      .unit = "kg/m^3",
                      .required = true,
                      .min = 0,
                      .example = "values = [1000.0]"}}});
    return list;
}

Key surface() {
    return {.name = "surface",
            .type = Type::numbers,
            .doc =
                "A point of the surface: pressure begins as rho g.(x - surface) where that is positive, of effects.gravity. "
                "Needs a density by its rate (delta, continuity); absent: the same of liquid that begins at rest, below a flat top and "
                "held by walls and solids, and no pressure of other liquid.",
            .unit = "m",
            .length = -1};
}

}  // namespace

scene::SolverKind kind() {
    const char* doc = "Smoothed particle hydrodynamics (Müller, Charypar & Gross 2003), weakly compressible.";
    return {
        particles::schema_of({.name = "sph", .doc = doc, .keys = {scheme()}, .effects = effects(), .without = {"time.cfl"}}, {surface()}),
        particles::make_solver<SphSolver, ReferenceSphSolver, DeviceSphSolver>,
        particles::plain_step({"pressure"}, {"neighbours", "density", "forces", "integrate"}),
        {.check = particles::refuse_in_parallel, .shared = scene::Shared::by_particles}};
}

}  // namespace weir::sph
