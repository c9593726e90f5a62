// One step of SPH by the plain double-precision reference over all pairs, from any state: what every backend is compared with; and scenes
// in which each term of the physics acts.
#pragma once
#include "scene/scene.hpp"
#include "shared/surroundings.hpp"
#include "sph/solver.hpp"

#include <fmt/core.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace weir::test {

using particles::Fluid;
using particles::Point;

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

namespace text {
#define WEIR_FN inline
#include "particles/kernels/sph_state.inl"
#undef WEIR_FN
}  // namespace text

/// The state in the reference's coordinates.
template <int D>
std::pair<std::vector<Point>, std::vector<Point>> points_of(const Fluid<D>& fluid) {
    std::vector<Point> x, v;
    for (int i = 0; i < fluid.count(); ++i) {
        x.push_back({0, 0, 0}), v.push_back({0, 0, 0});
        for (int a = 0; a < D; ++a) {
            x.back()[static_cast<std::size_t>(a)] = fluid.position(i)[a] - fluid.domain.centre()[a];
            v.back()[static_cast<std::size_t>(a)] = fluid.velocity(i)[a];
        }
    }
    return {x, v};
}

/// Of solids that are stuck to: 2 nu plane / phi along the surface (Morris et al. 1997, sec. 3.2).
template <int D>
void add_drag_of_solids(const sph::Options& o, const particles::ReferenceSph& reference, const Fluid<D>& fluid, std::vector<Point>& to) {
    const auto& solids = fluid.domain.solids;
    for (std::size_t i = 0; i < reference.solid.size(); ++i) {
        const Vec<D> x = fluid.position(static_cast<int>(i));
        Vec<D> pull;
        for (int a = 0; a < D; ++a) pull[a] = reference.solid[i][static_cast<std::size_t>(a)];
        const real plane = norm(pull), phi = std::max(solids.distance(x), 0.25 * fluid.domain.spacing);
        if (plane == 0 || !solids[solids.nearest(x)].no_slip) continue;
        const Vec<D> slip = solids.velocity(x) - fluid.velocity(static_cast<int>(i)),
                     along = slip - dot(slip, pull) / (plane * plane) * pull;
        for (int a = 0; a < D; ++a) to[i][static_cast<std::size_t>(a)] += 2 * o.viscosity * plane / phi * along[a];
    }
}

/// One step by the double reference: densities, and positions before walls keep them.
template <int D>
std::pair<std::vector<double>, std::vector<Vec<D>>> reference_step(const sph::Options& o, const Fluid<D>& before, real dt) {
    const real d = before.domain.spacing;
    particles::ReferenceSph reference;
    reference.p = sph::sph_params<particles::plain::SphParams, D>(o, d, before.rho0);
    reference.walls =
        before.domain.template walls<particles::plain::WallParams>(sph::density_kernel<D>(o, d), sph::gradient_kernel<D>(o, d));
    reference.kernel = static_cast<int>(o.smoothing);
    reference.period = periods(before.domain);
    reference.summed = !o.continuity;
    const auto [x, v] = points_of(before);
    add_solids(reference, before.domain, x);
    std::vector<double> rho = o.continuity ? before.density : reference.densities(x), pressure;
    for (const double r : rho) pressure.push_back(o.pressure(r, before.rho0));
    auto acceleration = reference.accelerations(x, v, rho, pressure);
    add_drag_of_solids(o, reference, before, acceleration);
    const auto tension = reference.tensions(x, rho);
    std::vector<Point> moved = v;
    std::vector<Vec<D>> after;
    for (std::size_t i = 0; i < x.size(); ++i) {
        after.push_back(before.position(static_cast<int>(i)));
        for (std::size_t a = 0; a < D; ++a) {
            moved[i][a] += dt * (acceleration[i][a] + tension[i][a] + o.gravity[a]);
            after.back()[static_cast<int>(a)] += dt * moved[i][a];
        }
    }
    if (o.continuity) {
        auto rate = reference.rates(x, moved, before.density, before.rho0);
        for (std::size_t i = 0; i < reference.solid.size(); ++i)
            for (int a = 0; a < D; ++a)
                rate[i] -= 2 * rho[i] * before.domain.solids.velocity(before.position(static_cast<int>(i)))[a] *
                           reference.solid[i][static_cast<std::size_t>(a)];
        for (std::size_t i = 0; i < rho.size(); ++i) rho[i] *= text::density_growth(dt * rate[i] / rho[i]);
    }
    return {rho, after};
}

/// The largest differences of a state from what is expected: densities, and places before walls and solids keep them.
struct Difference {
    real place = 0, density = 0;
    template <int D>
    Difference(const particles::Domain<D>& domain, const Fluid<D>& fluid, const std::vector<double>& rho, const std::vector<Vec<D>>& free) {
        for (int i = 0; i < fluid.count(); ++i) {
            const auto at = static_cast<std::size_t>(i);
            place = std::max(place, norm(apart(domain, fluid.position(i), domain.kept(free[at]))));
            density = std::max(density, std::abs(fluid.density[at] - rho[at]));
        }
    }
};

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
