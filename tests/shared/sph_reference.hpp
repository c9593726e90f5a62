// One step of SPH by the plain double-precision reference over all pairs, from any state: what every backend is compared with; and scenes
// in which each term of the physics acts.
#pragma once
#include "scene/scene.hpp"
#include "shared/surroundings.hpp"
#include "sph/reference_solver.hpp"
#include "sph/solver.hpp"

#include <fmt/core.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace weir::test {

using particles::Fluid;

/// A block of liquid in a box of 8 x 12 [x 8] spacings of 1/8 m.
template <int D>
scene::Scene sph_scene(const std::string& scheme, const std::string& effects) {
    const std::string text = fmt::format(
        "title = \"test\"\nsolver = \"sph\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 10.0, dt = 0.002 }}\n"
        "fluid = {{ density = 1000.0, viscosity = 0.01 }}\nliquid = [{{ shape = \"box\", min = {}, max = {} }}]\nscheme = {{ {} }}\n{}\n",
        D, D == 2 ? "[8, 12]" : "[8, 12, 8]", D == 2 ? "[1, 1.5]" : "[1, 1.5, 1]", D == 2 ? "[0.25, 0.25]" : "[0.25, 0.25, 0.25]",
        D == 2 ? "[1, 1]" : "[1, 1, 1]", scheme, effects);
    return scene::parse(text, "test.toml", {sph::kind().schema});
}

template <int D>
void shake(Fluid<D>& fluid, real amount) {
    std::mt19937 random(7);
    std::uniform_real_distribution<real> jitter(-1, 1);
    for (int i = 0; i < fluid.count(); ++i) {
        Vec<D> x = fluid.position(i), u{};
        for (int a = 0; a < D; ++a) x[a] += amount * fluid.domain.spacing * jitter(random), u[a] = 0.2 * jitter(random);
        Fluid<D>::put(fluid.x, i, fluid.domain.wrapped(fluid.domain.kept(x)));
        Fluid<D>::put(fluid.v, i, fluid.velocity(i) + u);
        fluid.density[static_cast<std::size_t>(i)] = fluid.rho0 * (1 + 0.02 * jitter(random));  // continuity starts from it
    }
}

/// The same step by the reference.
template <int D>
Fluid<D> reference_step(const sph::Options& o, const Fluid<D>& before, real dt) {
    sph::ReferenceSphSolver<D> solver(o, before);
    solver.step(dt);
    return solver.fluid();
}

/// How far two states of the same particles are apart.
struct Difference {
    real place = 0, density = 0;
    template <int D>
    Difference(const Fluid<D>& a, const Fluid<D>& b) {
        for (int i = 0; i < a.count(); ++i) {
            const auto at = static_cast<std::size_t>(i);
            place = std::max(place, norm(apart(a.domain, a.position(i), b.position(i))));
            density = std::max(density, std::abs(a.density[at] - b.density[at]));
        }
    }
};
/// How far forces have moved any particle in a step.
template <int D>
real farthest_moved(const Fluid<D>& before, const Fluid<D>& after, real dt) {
    real farthest = 0;
    for (int i = 0; i < before.count(); ++i)
        farthest = std::max(farthest, norm(after.position(i) - before.domain.kept(before.position(i) + dt * before.velocity(i))));
    return farthest;
}

/// Each pair term, and each wall term, in some scene.
struct Physics {
    const char *scheme, *effects;
};
template <int D>
std::vector<Physics> all_physics() {
    const bool flat = D == 2;
    return {{"density = \"summation\"", "effects.viscosity = {}\neffects.artificial_viscosity = { alpha = 0.1 }"},
            {"density = \"continuity\", tension = true",
             "effects.density_diffusion = { delta = 0.5 }\neffects.surface_tension = { sigma = 50 }"},
            {"density = \"continuity\"",
             flat ? "effects.gravity = { g = [3, -9.81] }\neffects.density_diffusion = {}\neffects.viscosity = {}\n"
                    "sides.x_max = { kind = \"wall\", slip = \"no\" }\nsides.y_max = { kind = \"moving_wall\", velocity = [2, 0] }"
                  : "effects.gravity = { g = [3, -9.81, 1] }\neffects.density_diffusion = {}\neffects.viscosity = {}\n"
                    "sides.z_max = { kind = \"wall\", slip = \"no\" }\nsides.x_max = { kind = \"moving_wall\", velocity = [0, 2, 1] }"}};
}

}  // namespace weir::test
