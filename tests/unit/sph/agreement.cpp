// SPH on the fast path against the double reference over all pairs; threads; momentum; the time-step limits.
#include "core/parallel.hpp"
#include "shared/sph_reference.hpp"
#include "sph/solver.hpp"

#include "support/test.hpp"

namespace agreement_tests {

using namespace weir;
using particles::Fluid;
using test::all_physics;
using test::Physics;
using test::reference_step;
using test::shake;
using test::sph_scene;

TEST_IN_2D_AND_3D("every instruction set agrees with the double reference to 1e-5 of the support after one step") {
    const real dt = 0.002;
    for (const auto* table : particles::available_passes())
        for (const char* kernel : {"muller", "cubic", "wendland"})
            for (const Physics& physics : all_physics<D>()) {
                sph::SphSolver<D> solver(
                    sph_scene<D>(fmt::format("kernel = \"{}\", support = 2.0, sound_speed = 10, backend = \"threads:{}\", {}", kernel,
                                             table->name, physics.scheme),
                                 physics.effects));
                shake(solver.fluid(), 0.2);
                const Fluid<D> before = solver.fluid();
                const Fluid<D> expected = reference_step<D>(solver.options(), before, dt);
                const real h = solver.options().support * before.domain.spacing;
                solver.step(dt);
                const test::Difference worst(solver.fluid(), expected);
                EXPECT_GT(test::farthest_moved(before, expected, dt), 1e-4 * h);  // forces must be there to be compared
                EXPECT_LE(worst.place, 1e-5 * h) << table->name << " " << kernel << " " << physics.effects;
                EXPECT_LE(worst.density, 1e-4 * before.rho0) << table->name << " " << kernel << " " << physics.effects;
            }
}

TEST("each effect on pairs and walls does something in the scenes of the comparison") {
    const auto after = [](const Physics& physics, const std::string& scheme) {
        sph::SphSolver<2> solver(sph_scene<2>(scheme, physics.effects));
        shake(solver.fluid(), 0.2);
        solver.step(0.002);
        return std::pair{solver.fluid().v, solver.fluid().density};
    };
    const std::string continuity = "density = \"continuity\", tension = true";
    const auto still = after({"", ""}, continuity);
    EXPECT_NE(after({"", "effects.density_diffusion = { delta = 0.5 }"}, continuity).second, still.second);
    EXPECT_NE(after({"", "effects.surface_tension = { sigma = 50 }"}, continuity).first, still.first);
    const auto sticky = after({"", "effects.viscosity = {}"}, continuity);
    EXPECT_NE(sticky.first, still.first);
    EXPECT_NE(after({"", "effects.viscosity = {}\nsides.x_max = { kind = \"wall\", slip = \"no\" }"}, continuity).first, sticky.first);
}

TEST_IN_2D_AND_3D("a free drop keeps its momentum to round-off, whatever its particles do to each other") {
    sph::SphSolver<D> solver(sph_scene<D>("support = 2.0, tension = true", "effects.viscosity = {}\neffects.artificial_viscosity = {}"));
    shake(solver.fluid(), 0.1);
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
    sph::SphSolver<2> sound(sph_scene<2>("support = 2.0, density = \"continuity\", sound_speed = 50", ""));
    EXPECT_NEAR(sound.advised_dt(), 0.4 * 0.125 / 50, 1e-12);  // smoothing length 0.125 m, nothing moves
    sph::SphSolver<2> honey(sph_scene<2>("support = 2.0, density = \"continuity\", sound_speed = 1e-3", "effects.viscosity = {}"));
    EXPECT_NEAR(honey.advised_dt(), 0.125 * 0.125 * 0.125 / 0.01, 1e-12);
}

TEST("a scene that names no speed of sound gets ten times the fastest flow that it can tell") {
    const auto sound = [](const std::string& more) { return sph::SphSolver<2>(sph_scene<2>("", more)).options().sound; };
    const real fall = std::sqrt(2 * 9.81 * 0.9375);  // from the highest particle to the floor
    EXPECT_NEAR(sound("effects.gravity = { g = [0, -9.81] }"), 10 * fall, 1e-9);
    EXPECT_EQ(sound(""), 10);  // nothing tells
    EXPECT_NEAR(sound("initial.velocity = { name = \"constant\", value = [3, 4] }"), 50, 1e-9);
    EXPECT_NEAR(sound("effects.viscosity = {}\nsides.x_max = { kind = \"moving_wall\", velocity = [0, 7] }"), 70, 1e-9);
    EXPECT_NEAR(sound("emitters = [ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.1, velocity = [8, 0] } ]"), 80, 1e-9);
    EXPECT_NEAR(sound("solids = [ { shape = \"sphere\", centre = [0.8, 0.8], radius = 0.1, motion = { kind = \"constant\", velocity = "
                      "[0, 9] } } ]"),
                90, 1e-9);
    EXPECT_EQ(sph::SphSolver<2>(sph_scene<2>("sound_speed = 5", "effects.gravity = { g = [0, -9.81] }")).options().sound, 5);
}

TEST("delta-SPH is continuity with its published constants, and effects of the same names set others") {
    const auto run = [](const std::string& scheme, const std::string& effects) {
        sph::SphSolver<2> solver(sph_scene<2>(scheme, effects));
        shake(solver.fluid(), 0.2);
        for (int s = 0; s < 5; ++s) solver.step(0.001);
        return std::pair{solver.fluid().x, solver.fluid().density};
    };
    const auto spelled =
        run("density = \"continuity\"", "effects.density_diffusion = { delta = 0.1 }\neffects.artificial_viscosity = { alpha = 0.02 }");
    EXPECT_EQ(run("", ""), spelled);
    EXPECT_EQ(run("density = \"delta\"", "effects.density_diffusion = { delta = 0 }\neffects.artificial_viscosity = { alpha = 0 }"),
              run("density = \"continuity\"", ""));
}

TEST("an effect without strength changes no bit: what is not named is not there") {
    const std::string scheme = "density = \"continuity\", tension = true";
    const auto run = [&](const std::string& effects) {
        sph::SphSolver<2> solver(sph_scene<2>(scheme, effects));
        shake(solver.fluid(), 0.2);
        for (int s = 0; s < 10; ++s) solver.step(0.001);
        return std::pair{solver.fluid().x, solver.fluid().density};
    };
    const auto plain = run("");
    EXPECT_EQ(run("effects.density_diffusion = { delta = 0 }"), plain);
    EXPECT_EQ(run("effects.surface_tension = { sigma = 0 }"), plain);
    EXPECT_EQ(run("effects.artificial_viscosity = { alpha = 0 }"), plain);
    EXPECT_NE(run("effects.artificial_viscosity = { alpha = 0.1 }"), plain);
}

TEST_IN_2D_AND_3D("a solid that is stuck to drags as a wall does, and one that slides past drags along") {
    // the same channel, its floor a side of the domain or a plate below y = 0.25
    const auto speed_above = [&](bool plate, const std::string& slip, const std::string& motion) {
        const std::string at = D == 2 ? "[0, {}], max = [1, {}]" : "[0, {}, 0], max = [1, {}, 1]";
        const std::string text = fmt::format(
            "title = \"test\"\nsolver = \"sph\"\ndim = {}\ngrid = {{ cells = {}, size = {}, periodic = [\"x\"{}] }}\n"
            "time = {{ end = 10.0, dt = 0.002 }}\nfluid = {{ density = 1000.0, viscosity = 0.01 }}\n"
            "liquid = [{{ shape = \"box\", min = {} }}]\nscheme = {{ support = 2.0, sound_speed = 10 }}\neffects.viscosity = {{}}\n"
            "initial.velocity = {{ name = \"constant\", value = {} }}\n{}\n",
            D, D == 2 ? "[8, 12]" : "[8, 12, 8]", D == 2 ? "[1, 1.5]" : "[1, 1.5, 1]", D == 2 ? "" : ", \"z\"",
            fmt::format(fmt::runtime(at), plate ? 0.25 : 0.0, plate ? 1.25 : 1.0), D == 2 ? "[1, 0]" : "[1, 0, 0]",
            plate ? fmt::format("solids = [{{ shape = \"box\", min = {}, slip = \"{}\"{} }}]", fmt::format(fmt::runtime(at), -1, 0.25),
                                slip, motion)
                  : fmt::format("sides.y_min = {{ kind = \"wall\", slip = \"{}\" }}", slip));
        sph::SphSolver<D> solver(scene::parse(text, "test.toml", {sph::kind().schema}));
        for (int s = 0; s < 50; ++s) solver.step(0.002);
        real sum = 0;  // momentum along x per particle
        for (int i = 0; i < solver.fluid().count(); ++i) sum += solver.fluid().velocity(i)[0] / solver.fluid().count();
        return sum;
    };
    const real wall = speed_above(false, "no", "");
    EXPECT_LT(wall, 0.99);
    EXPECT_NEAR(speed_above(true, "no", ""), wall, 1e-4);
    EXPECT_NEAR(speed_above(true, "free", ""), 1, 1e-4);
    const std::string along = std::string(", motion = { kind = \"constant\", velocity = ") + (D == 2 ? "[1, 0] }" : "[1, 0, 0] }");
    EXPECT_NEAR(speed_above(true, "no", along), 1, 1e-4);
}

TEST("walls that would do nothing are refused: an inflow, and what sticks without viscosity") {
    EXPECT_THROW(sph::SphSolver<2>(sph_scene<2>("", "sides.x_min = { kind = \"inflow\", velocity = [1, 0] }")), scene::BadScene);
    EXPECT_THROW(sph::SphSolver<2>(sph_scene<2>("", "sides.x_min = { kind = \"wall\", slip = \"no\" }")), scene::BadScene);
    EXPECT_THROW(
        sph::SphSolver<2>(sph_scene<2>("", "solids = [ { shape = \"sphere\", centre = [0.8, 0.8], radius = 0.1, slip = \"no\" } ]")),
        scene::BadScene);
}

TEST("surface tension without tension, diffusion of a summed density, a surface for one: each is refused") {
    EXPECT_THROW(sph::SphSolver<2>(sph_scene<2>("density = \"continuity\"", "effects.surface_tension = { sigma = 1 }")), scene::BadScene);
    EXPECT_THROW(sph::SphSolver<2>(sph_scene<2>("density = \"summation\"", "effects.density_diffusion = {}")), scene::BadScene);
    EXPECT_THROW(sph::SphSolver<2>(sph_scene<2>("density = \"summation\"", "initial.surface = [0, 1]")), scene::BadScene);
}

TEST("elastic energy is the work of compression: the integral of p / rho^2, which Simpson's rule gives to nine digits") {
    for (const real gamma : {1.0, 7.0})
        for (const bool tension : {false, true})
            for (const real rho : {900.0, 990.0, 1000.0, 1010.0, 1100.0}) {
                sph::Options o;
                o.gamma = gamma, o.tension = tension, o.sound = 30;
                const int n = 2000;
                const real rho0 = 1000, step = (rho - rho0) / n;
                real sum = 0;
                for (int i = 0; i <= n; ++i) {
                    const real at = rho0 + i * step, weight = i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2;
                    sum += weight * o.pressure(at, rho0) / (at * at) * step / 3;
                }
                EXPECT_NEAR(o.elastic_energy(rho, rho0), sum, 1e-9 * (std::abs(sum) + 1e-3)) << gamma << ' ' << tension << ' ' << rho;
            }
}

}  // namespace agreement_tests
