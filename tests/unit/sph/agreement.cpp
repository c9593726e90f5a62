// SPH on the fast path against the double reference over all pairs; threads; momentum; the time-step limits.
#include "core/parallel.hpp"
#include "particles/reference.hpp"
#include "scene/scene.hpp"
#include "sph/solver.hpp"

#include "support/test.hpp"

#include <fmt/core.h>

#include <random>

using namespace weir;
using particles::Fluid;
using particles::Point;

namespace {

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
void disturb(Fluid<D>& fluid, real shake) {
    std::mt19937 random(7);
    std::uniform_real_distribution<real> jitter(-1, 1);
    for (int i = 0; i < fluid.count(); ++i) {
        Vec<D> x = fluid.position(i), u{};
        for (int a = 0; a < D; ++a) x[a] += shake * fluid.domain.spacing * jitter(random), u[a] = 0.2 * jitter(random);
        Fluid<D>::put(fluid.x, i, fluid.domain.kept(x));
        Fluid<D>::put(fluid.v, i, u);
    }
}

}  // namespace

TEST_IN_2D_AND_3D("every instruction set agrees with the double reference to 1e-5 of the support after one step") {
    const real dt = 0.002;
    for (const auto* table : particles::available_passes())
        for (const char* kernel : {"muller", "cubic", "wendland"}) {
            sph::SphSolver<D> solver(sph_scene<D>(fmt::format("kernel = \"{}\", isa = \"{}\"", kernel, table->name),
                                                  "effects.viscosity = {}\neffects.artificial_viscosity = { alpha = 0.1 }"));
            disturb(solver.fluid(), 0.2);
            const auto before = solver.fluid();
            const auto& o = solver.options();
            const real d = before.domain.spacing, h = o.support * d;
            particles::ReferenceSph reference;
            reference.p = sph::sph_params<particles::plain::SphParams, D>(o, d, before.rho0);
            reference.walls =
                before.domain.template walls<particles::plain::WallParams>(sph::density_kernel<D>(o, d), sph::gradient_kernel<D>(o, d));
            reference.kernel = static_cast<int>(o.smoothing);
            std::vector<Point> x, v;
            for (int i = 0; i < before.count(); ++i) {
                Point p{0, 0, 0}, u{0, 0, 0};
                for (int a = 0; a < D; ++a) {
                    p[static_cast<std::size_t>(a)] = before.position(i)[a] - before.domain.centre()[a];
                    u[static_cast<std::size_t>(a)] = before.velocity(i)[a];
                }
                x.push_back(p), v.push_back(u);
            }
            const auto rho = reference.densities(x);
            std::vector<double> pressure;
            for (const double r : rho) pressure.push_back(o.pressure(r, before.rho0));
            const auto acceleration = reference.accelerations(x, v, rho, pressure);
            solver.step(dt);
            real worst = 0, strongest = 0, densest = 0;
            for (int i = 0; i < before.count(); ++i) {
                const auto at = static_cast<std::size_t>(i);
                Vec<D> expected = before.position(i);
                for (int a = 0; a < D; ++a) {
                    const auto axis = static_cast<std::size_t>(a);
                    expected[a] += dt * (v[at][axis] + dt * acceleration[at][axis]);
                    strongest = std::max(strongest, std::abs(acceleration[at][axis]));
                }
                worst = std::max(worst, norm(solver.fluid().position(i) - before.domain.kept(expected)));
                densest = std::max(densest, std::abs(solver.fluid().density[at] - rho[at]));
            }
            EXPECT_GT(strongest * dt * dt, 1e-4 * h);  // forces must be there to be compared
            EXPECT_LE(worst, 1e-5 * h) << table->name << " " << kernel;
            EXPECT_LE(densest, 1e-4 * before.rho0) << table->name << " " << kernel;
        }
}

TEST_IN_2D_AND_3D("a free drop keeps its momentum to round-off, whatever its particles do to each other") {
    sph::SphSolver<D> solver(sph_scene<D>("tension = true", "effects.viscosity = {}\neffects.artificial_viscosity = {}"));
    disturb(solver.fluid(), 0.1);
    for (int i = 0; i < solver.fluid().count(); ++i)  // away from the walls
        for (int a = 0; a < D; ++a) {
            auto& xa = solver.fluid().x[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
            xa = (a == 1 ? 0.75 : 0.5) + 0.6 * (xa - 0.6);
        }
    const auto momentum = [&](int axis) {
        real sum = 0, size = 0;
        for (int i = 0; i < solver.fluid().count(); ++i)
            sum += solver.fluid().velocity(i)[axis], size += std::abs(solver.fluid().velocity(i)[axis]);
        return std::pair{sum, size};
    };
    std::array<real, D> before{};
    for (int a = 0; a < D; ++a) before[static_cast<std::size_t>(a)] = momentum(a).first;
    for (int s = 0; s < 5; ++s) solver.step(0.0005);
    for (int a = 0; a < D; ++a)  // every pair's two forces are rounded apart, each to 6e-8 of itself
        EXPECT_NEAR(momentum(a).first, before[static_cast<std::size_t>(a)], 1e-5 * momentum(a).second);
}

TEST_IN_2D_AND_3D("results are equal to the last bit for one, two and three threads") {
    std::vector<std::array<std::vector<real>, D>> results;
    for (const int count : {1, 2, 3}) {
        set_threads(count);
        sph::SphSolver<D> solver(
            sph_scene<D>("", D == 2 ? "effects.gravity = { g = [0, -9.81] }" : "effects.gravity = { g = [0, -9.81, 0] }"));
        for (int s = 0; s < 20; ++s) solver.step(0.002);
        results.push_back(solver.fluid().x);
    }
    set_threads(2);
    for (const auto& x : results) EXPECT_EQ(x, results.front());
}

TEST("the advised step obeys the acoustic and the viscous limit") {
    sph::SphSolver<2> sound(sph_scene<2>("sound_speed = 50", ""));
    EXPECT_NEAR(sound.advised_dt(), 0.4 * 0.125 / 50, 1e-12);  // smoothing length 0.125 m, nothing moves
    sph::SphSolver<2> honey(sph_scene<2>("sound_speed = 1e-3", "effects.viscosity = {}"));
    EXPECT_NEAR(honey.advised_dt(), 0.125 * 0.125 * 0.125 / 0.01, 1e-12);
}
