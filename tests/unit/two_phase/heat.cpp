// Heat in both fluids: its content, its bounds, sides, solids and buoyancy.
#include "support.hpp"

#include "core/error.hpp"

namespace heat_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

/// A column of warm liquid, 1000:1, that falls over in a closed tank. Heat capacities of water and air.
template <int D>
scene::Scene tumbling(const std::string& conductivity, const std::vector<scene::Override>& changes = {}) {
    return two_phase_scene(
        fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 10.0 }}
fluid = {{ density = 1000.0, heat_capacity = 4000.0, conductivity = {} }}
gas = {{ density = 1.0, heat_capacity = 1000.0, conductivity = {} }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
initial = {{ temperature = {{ name = "formula", value = "3*sin(9*y) + 290 + 5*x" }}, liquid_temperature = 350.0 }}
effects = {{ gravity = {{ g = {} }}, heat = {{}} }}
scheme = {{ poisson = {{ tolerance = 1e-8 }} }}
)",
                    D, list({"16", "16", "10"}, D), list({"1.0", "1.0", "0.625"}, D), conductivity, conductivity,
                    list({"-1.0", "-1.0", "-1.0"}, D), list({"0.41", "0.63", "0.33"}, D), list({"1.0", "-9.81", "0.7"}, D)),
        changes);
}

}  // namespace

// The sum of n^D contents, each with the round-off of D sweeps and a solve, over some hundred steps. A fluid that fills a millionth of a
// cell has a content of 350 K · 1e-6 with a round-off of 8e-14, so its temperature is known to 8e-8 K per sweep.
TEST_IN_2D_AND_3D("a tumbling flow in a closed box keeps its heat to round-off, and temperatures stay between those of the start") {
    for (const char* conductivity : {"0.0", "10.0"}) {
        TwoPhase<D> solver(tumbling<D>(conductivity));
        const real heat = integral(solver, "heat"), coldest = integral(solver, "coldest"), hottest = integral(solver, "hottest");
        for (int step = 0; step < (D == 2 ? 300 : 60); ++step) {
            solver.step(solver.advised_dt());
            ASSERT_GT(integral(solver, "coldest") - coldest, -1e-6);
            ASSERT_LT(integral(solver, "hottest") - hottest, 1e-6);
        }
        EXPECT_NEAR(integral(solver, "heat") / heat, 1, 1e-14);
        EXPECT_EQ(integral(solver, "heat_added"), 0);
        EXPECT_GT(max_speed(solver), 1) << "something moved";
    }
}

TEST_IN_2D_AND_3D("heat has the same bits by one thread, by three, and after a restart") {
    expect_reproducible<D>(tumbling<D>("10.0"), 7, 4);
}

// The walls are the only way in: the content grows by what they add, to the round-off of the sums. With dt ≤ ½ √(h/g) = 0.04 s, dt k/(ρc
// h²) of the gas is at most 0.51: conjugate gradients take at most ½ √(1 + 4 · 3 · 0.51) ln(2e10) = 32 iterations (Saad 2003,
// equation 6.128).
TEST_IN_2D_AND_3D("walls with a temperature warm a moving liquid, and the balance holds") {
    TwoPhase<D> solver(tumbling<D>(
        "50.0", {{"sides.x_min", "{ kind = \"wall\", temperature = 400.0 }"},
                 {"sides.y_max", "{ kind = \"moving_wall\", velocity = " + list({"1.0", "0.0", "0.0"}, D) + ", temperature = 330.0 }"}}));
    const real heat = integral(solver, "heat");
    int iterations = 0;
    for (int step = 0; step < 40; ++step) {
        solver.step(solver.advised_dt());
        iterations = std::max(iterations, solver.heat()->iterations());
    }
    EXPECT_LE(iterations, 32);
    EXPECT_GT(integral(solver, "heat_added"), 1e-5 * heat);
    EXPECT_NEAR((integral(solver, "heat") - integral(solver, "heat_added")) / heat, 1, 1e-14);
    EXPECT_LT(integral(solver, "hottest"), 400);
}

namespace {

/// A drop of radius 0.2 m at 350 K in gas at 290 K, flung at 1 m/s along x.
template <int D>
scene::Scene flung(int n, const std::vector<scene::Override>& changes = {}) {
    return two_phase_scene(drop<D>(n,
                                   "initial = { temperature = { name = \"constant\", value = 290.0 }, liquid_temperature = 350.0, "
                                   "liquid_velocity = " +
                                       list({"1.0", "0.0", "0.0"}, D) + " }\neffects.heat = {}\n"),
                           [&] {
                               std::vector<scene::Override> all{{"fluid.heat_capacity", "4000.0"}, {"gas.heat_capacity", "1000.0"}};
                               all.insert(all.end(), changes.begin(), changes.end());
                               return all;
                           }());
}

}  // namespace

// No heat crosses the surface by advection: each fluid keeps its own temperature, to the round-off of a sliver's content (above) anywhere
// and to that of sums in the mean.
TEST_IN_2D_AND_3D("a warm drop that is flung through gas keeps its heat, and the gas stays cold") {
    TwoPhase<D> solver(flung<D>(D == 2 ? 32 : 16));
    const real heat = integral(solver, "heat");
    while (solver.time() < 0.3) solver.step(solver.advised_dt());
    EXPECT_NEAR(integral(solver, "liquid_temperature"), 350, 1e-10);
    EXPECT_NEAR(integral(solver, "gas_temperature"), 290, 1e-10);
    EXPECT_NEAR(integral(solver, "coldest"), 290, 1e-6);
    EXPECT_NEAR(integral(solver, "hottest"), 350, 1e-6);
    EXPECT_NEAR(integral(solver, "heat") / heat, 1, 1e-14);
}

namespace {

/// The mean error of a warm patch in a liquid that fills a periodic box of n^D cells, after half a length along x and a quarter along y.
template <int D>
real patch_error(int n) {
    const auto patch = [&](const char* x, const char* y) {
        return fmt::format(
            "{{ name = \"formula\", value = \"300 + 10*exp(5*cos(6.283185307179586*(x - {})) + 5*cos(6.283185307179586*(y - {})) - 10)\" "
            "}}",
            x, y);
    };
    const scene::Override all{
        "liquid", "[ { shape = \"box\", min = " + list({"-1.0", "-1.0", "-1.0"}, D) + ", max = " + list({"2.0", "2.0", "2.0"}, D) + " } ]"};
    const auto scene = flung<D>(
        n, {all, {"initial", "{ temperature = " + patch("0.5", "0.5") + ", liquid_velocity = " + list({"1.0", "0.5", "0.0"}, D) + " }"}});
    TwoPhase<D> solver(scene);
    const TwoPhase<D> exact(flung<D>(n, {all, {"initial", "{ temperature = " + patch("1.0", "0.75") + " }"}}));
    for (int step = 0; step < 2 * n; ++step) solver.step(0.25 / n);
    return sum_over(temperature(solver).extent(),
                    [&](const Index<D>& I) { return std::abs(temperature(solver)(I) - temperature(exact)(I)); }) /
           std::pow(n, D);
}

}  // namespace

// Inside one fluid limited slopes are of second order but at the maximum: errors in the mean fall by nearly four. Without slopes they would
// fall by less than two.
TEST("a warm patch in a moving liquid is carried with second order") {
    const real coarse = patch_error<2>(24), fine = patch_error<2>(48);
    EXPECT_GT(coarse / fine, 3);
}

// Ghosts beyond a periodic side are those of its other end, in each sweep. Multigrid visits cells in another order: the solve's tolerance
// 1e-12 over ten steps, times 60 K.
TEST_IN_2D_AND_3D("a warm flight shifted by whole cells in a periodic box is the shifted image") {
    const int n = D == 2 ? 24 : 16;
    const auto flight = [&](const char* x, const char* shift) {
        const std::string waves = fmt::format("3*sin(6.283185307179586*(x{}))*cos(6.283185307179586*y)", shift);
        return flung<D>(n, {{"liquid[0].centre", list({x, "0.5", "0.5"}, D)},
                            {"initial.liquid_velocity", list({"1.0", "0.5", "0.2"}, D)},
                            {"gas.conductivity", "100.0"},
                            {"initial.temperature", "{ name = \"formula\", value = \"290 + " + waves + "\" }"}});
    };
    TwoPhase<D> here(flight("0.5", "")), there(flight("0.75", "-0.25"));
    run(here, 10);
    run(there, 10);
    EXPECT_LT(max_over(temperature(here).extent(),
                       [&](const Index<D>& I) {
                           Index<D> J = I;
                           J[0] = (I[0] + n / 4) % n;
                           return std::abs(temperature(here)(I) - temperature(there)(J));
                       }),
              1e-6);
}

namespace {

/// A channel of 2 m by 1 m (by 0.5 m), 1000:1. Liquid of 320 K enters a bed of 300 K on the left; the right side is open.
template <int D>
std::string channel(const std::string& outside) {
    return fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 10.0 }}
fluid = {{ density = 1000.0, heat_capacity = 4000.0, conductivity = 100.0 }}
gas = {{ density = 1.0, heat_capacity = 1000.0, conductivity = 1.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
initial = {{ temperature = {{ name = "constant", value = 290.0 }}, liquid_temperature = 300.0 }}
sides = {{ x_min = {{ kind = "inflow", velocity = {}, temperature = 320.0 }}, x_max = {{ kind = "outflow"{} }} }}
effects = {{ gravity = {{ g = {} }}, heat = {{}} }}
scheme = {{ poisson = {{ tolerance = 1e-10 }} }}
)",
                       D, list({"24", "12", "6"}, D), list({"2.0", "1.0", "0.5"}, D), list({"-1.0", "-1.0", "-1.0"}, D),
                       list({"3.0", "0.36", "2.0"}, D), list({"0.8", "0.0", "0.0"}, D), outside, list({"0.0", "-9.81", "0.0"}, D));
}

}  // namespace

// What the fluxes through sides bring is all that changes the content, to the round-off of sums. Liquid leaves on the right and gas comes
// in above it, at the given temperature or at that of the fluid within.
TEST_IN_2D_AND_3D("heat comes in with an inflow and leaves through an open side, and the balance holds") {
    for (const char* outside : {"", ", temperature = 280.0"}) {
        TwoPhase<D> solver(two_phase_scene(channel<D>(outside)));
        const real heat = integral(solver, "heat");
        for (int step = 0; step < (D == 2 ? 150 : 60); ++step) {
            solver.step(solver.advised_dt());
            ASSERT_NEAR((integral(solver, "heat") - integral(solver, "poured_heat")) / heat, 1, 1e-13);
        }
        EXPECT_GT(std::abs(integral(solver, "poured_heat")), 0.05 * heat);
        EXPECT_GT(integral(solver, "liquid_temperature"), 303);
        EXPECT_NEAR(integral(solver, "hottest"), 320, 1e-6);
        EXPECT_NEAR(integral(solver, "coldest"), *outside ? 280 : 290, *outside ? 10 : 1e-6);
    }
}

// Liquid fills the channel at the speed of the inflow: 4000 · 1000 · 320 J/m³ of it, to the round-off of the fluxes.
TEST_IN_2D_AND_3D("an inflow brings its volume times its capacity times its temperature") {
    TwoPhase<D> solver(two_phase_scene(channel<D>(""), {{"effects.gravity.g", list({"0.0", "0.0", "0.0"}, D)},
                                                        {"liquid", "[ { shape = \"box\", min = " + list({"-1.0", "-1.0", "-1.0"}, D) +
                                                                       ", max = " + list({"0.5", "2.0", "2.0"}, D) + " } ]"}}));
    while (solver.time() < 0.5) solver.step(solver.advised_dt());
    const real area = D == 2 ? 1 : 0.5, entered = 4e6 * 320 * 0.8 * solver.time() * area, left = 1e3 * 290 * 0.8 * solver.time() * area;
    EXPECT_NEAR(integral(solver, "poured_heat") / (entered - left), 1, 1e-9);  // the divergence that the pressure left
}

// A ball in the way: its cells hold no fluid and its faces conduct nothing. Contents and bounds are those of the fluids.
TEST_IN_2D_AND_3D("a solid at rest insulates") {
    TwoPhase<D> solver(
        tumbling<D>("50.0", {{"solids", "[ { shape = \"sphere\", centre = " + list({"0.72", "0.2", "0.3"}, D) + ", radius = 0.19 } ]"}}));
    const real heat = integral(solver, "heat"), coldest = integral(solver, "coldest"), hottest = integral(solver, "hottest");
    const auto is_solid = [&](const Index<D>& I) { return solver.state().cells(I) == poisson::Cell::solid; };
    const Grid<real, D> start = temperature(solver);
    run(solver, D == 2 ? 200 : 60);
    EXPECT_NEAR(integral(solver, "heat") / heat, 1, 1e-14);
    EXPECT_GT(integral(solver, "coldest") - coldest, -1e-6);
    EXPECT_LT(integral(solver, "hottest") - hottest, 1e-6);
    EXPECT_GT(sum_over(start.extent(), [&](const Index<D>& I) { return is_solid(I) ? 1.0 : 0.0; }), D == 2 ? 15 : 20);
}

// Uniform density: the pressure takes no curl away. After one step from rest the curl is dt β |g| dT/dx inside each fluid, with T linear in
// x; round-off of velocities of dt g.
TEST_IN_2D_AND_3D("buoyancy turns each fluid at the rate of its own expansion") {
    const auto scene =
        two_phase_scene(fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0, heat_capacity = 4000.0, expansion = 2e-4 }}
gas = {{ density = 1.0, heat_capacity = 1000.0, expansion = 3e-3 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
initial.temperature = {{ name = "formula", value = "7*x + 290" }}
effects = {{ gravity = {{ g = {} }}, heat = {{ ambient = 293.0 }} }}
)",
                                    D, list({"16", "16", "8"}, D), list({"1.0", "1.0", "0.5"}, D), list({"-1.0", "-1.0", "-1.0"}, D),
                                    list({"2.0", "0.5", "2.0"}, D), list({"0.0", "-9.81", "0.0"}, D)));
    TwoPhase<D> solver(scene);
    const real dt = 1e-3, h = 1.0 / 16;
    solver.step(dt);
    const auto& u = solver.state().u;
    for (const int j : {4, 12})
        for (int i = 3; i < 14; ++i) {
            Index<D> I{};
            I[0] = i, I[1] = j;
            const real curl = (u[1](I) - u[1](I - e<D>(0)) - u[0](I) + u[0](I - e<D>(1))) / h;
            EXPECT_NEAR(curl / (dt * 9.81 * (j == 4 ? 2e-4 : 3e-3) * 7), 1, 1e-9) << i << " " << j;
        }
}

TEST("heat is refused without its capacities, its temperatures, and beside moving solids") {
    const auto refusal = [](const std::vector<scene::Override>& changes) -> std::string {
        try {
            const TwoPhase<2> solver(two_phase_scene(channel<2>(""), changes));
        } catch (const BadInput& bad) {
            return bad.what();
        }
        return "";
    };
    const auto has = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
    };
    EXPECT_EQ(refusal({}), "");
    EXPECT_THROW(two_phase::kind().parallel.check(two_phase_scene(channel<2>(""))), BadInput) << "in parallel (MPI)";
    has(refusal({{"gas", "{ density = 1.0 }"}}), "requires \"gas.heat_capacity\"");
    has(refusal({{"fluid", "{ density = 1.0 }"}}), "requires \"fluid.heat_capacity\"");
    has(refusal({{"initial", "{ liquid_temperature = 300.0 }"}}), "requires \"initial.temperature\"");
    has(refusal({{"sides.x_min", "{ kind = \"inflow\", velocity = [1.0, 0.0] }"}}), "requires \"sides.x_min.temperature\"");
    has(refusal({{"solids",
                  "[ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.2, motion = { kind = \"constant\", velocity = [0.1, "
                  "0.0] } } ]"}}),
        "heat together with moving solids or bodies");
    has(refusal({{"bodies", "[ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.2, density = 500.0 } ]"}}),
        "heat together with moving solids or bodies");
}

}  // namespace heat_tests
