// What effects and sides do in one step, by their own formulas; energies and the advised step, by their sums.
#include "heightfield/effects.hpp"
#include "heightfield/sides.hpp"
#include "support/test.hpp"
#include "unit/heightfield/support.hpp"

#include <fmt/format.h>

#include <cmath>

namespace effects_tests {

using namespace weir;
using namespace weir::heightfield;

namespace {

real value(const Solver& solver, const std::string& name) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return std::nan("");
}

/// Water over hills, in columns that are no squares.
scene::Scene waves(const std::string& more, const std::string& gravity = "[0.0, -9.81, 0.0]") {
    return scene::parse(
        "solver = \"heightfield\"\ndim = 3\ngrid.cells = [20, 1, 12]\ngrid.size = [1.0, 1.0, 1.2]\ntime.end = 1.0\n"
        "terrain = { kind = \"formula\", height = \"0.05*sin(7*x)*cos(6*z)\" }\n"
        "initial = { surface = \"0.2 + 0.02*cos(5*x + 3*z)\", velocity = { name = \"formula\", x = \"0.4*sin(5*x + z)\", z = "
        "\"0.3*cos(4*z)\" } }\neffects.gravity.g = " +
            gravity + "\n" + more,
        "waves.toml", {heightfield::kind().schema});
}

/// The state after `dt` of a stage's effects alone.
State after(const scene::Scene& scene, Stage stage, real dt) {
    State state(scene);
    const auto effects = make_effects(scene, state, "");
    Passes passes;
    effects.apply(stage, state, dt, passes);
    return state;
}

}  // namespace

TEST("down a slope water gains its depth times the slope's part of gravity, along x and along z") {
    const auto scene = waves("", "[0.3, -9.81, -0.7]");
    const State before(scene), now = after(scene, Stage::force, 0.1);
    for (std::size_t c = 0; c < before.plane.count(); ++c) {
        ASSERT_NEAR(now.qx[c], before.qx[c] + 0.1 * 0.3 * before.h[c], 1e-16);  // round-off of a sum of some hundredths
        ASSERT_NEAR(now.qz[c], before.qz[c] - 0.1 * 0.7 * before.h[c], 1e-16);
    }
}

/// dq/dt = −g n² |q| q / h^(7/3) (Manning) or −c |q| q / h², taken at the end of the step: what is left solves q1 (1 + dt k |q1|/h²) = q.
TEST("friction of the bed follows Manning's law and the quadratic law, at the end of the step, along the flow") {
    for (const bool manning : {true, false}) {
        const auto scene = waves(manning ? "effects.friction = { law = \"manning\", n = 0.08 }\n"
                                         : "effects.friction = { law = \"quadratic\", c = 0.3 }\n");
        const real dt = 0.5;
        const State before(scene), now = after(scene, Stage::implicit, dt);
        real most = 0;
        for (std::size_t c = 0; c < before.plane.count(); ++c) {
            const real h = before.h[c], q = std::hypot(before.qx[c], before.qz[c]), left = std::hypot(now.qx[c], now.qz[c]);
            const real k = manning ? 9.81 * 0.08 * 0.08 / std::pow(h, 1.0 / 3) : 0.3;
            ASSERT_NEAR(left * (1 + dt * k * left / (h * h)), q, 1e-15);  // round-off of some tenths
            ASSERT_NEAR(now.qx[c] * before.qz[c], now.qz[c] * before.qx[c], 1e-16);
            most = std::max(most, 1 - left / q);
        }
        EXPECT_GT(most, 0.1);  // it does something
    }
}

TEST("damping leaves exp(-rate dt) of the discharge") {
    const auto scene = waves("effects.damping.rate = 0.7\n");
    const State before(scene), now = after(scene, Stage::implicit, 0.5);
    for (std::size_t c = 0; c < before.plane.count(); ++c) {
        ASSERT_NEAR(now.qx[c], std::exp(-0.35) * before.qx[c], 1e-16);
        ASSERT_NEAR(now.qz[c], std::exp(-0.35) * before.qz[c], 1e-16);
    }
}

TEST("rain over a part of the ground is counted as what it raises") {
    const auto scene = waves("effects.rain = { rate = 0.01, over = [0.2, 0.3, 0.7, 0.8], start = 0.02 }\n");
    const State before(scene), now = after(scene, Stage::source, 0.1);
    real rise = 0;
    for (std::size_t c = 0; c < before.plane.count(); ++c) rise += (now.h[c] - before.h[c]) * before.plane.area();
    EXPECT_NEAR(now.net_inflow, rise, 1e-15);
    EXPECT_NEAR(rise, 0.01 * 0.08 * 0.5 * 0.5, 1e-15);  // 10 by 5 columns
}

TEST("energies are the sums over columns of their water's: of motion q^2/2h, of place from the bed up") {
    for (const std::string model : {"shallow_water", "columns"}) {
        const bool moves = model == "shallow_water";
        const auto scene = moves ? waves("")
                                 : scene::parse(
                                       "solver = \"heightfield\"\ndim = 3\ngrid.cells = [20, 1, 12]\ngrid.size = [1.0, 1.0, 1.2]\n"
                                       "time.end = 1.0\neffects.gravity.g = [0.0, -9.81, 0.0]\ninitial.surface = \"0.2 + 0.02*cos(5*x)\"\n"
                                       "scheme.model = \"columns\"\n",
                                       "waves.toml", {heightfield::kind().schema});
        const State state(scene);
        const auto solver = test::height_solver(scene);
        real kinetic = 0, potential = 0, mean = 0;
        for (std::size_t c = 0; c < state.plane.count(); ++c) mean += (state.h[c] + state.bed[c]) / static_cast<real>(state.plane.count());
        for (std::size_t c = 0; c < state.plane.count(); ++c) {
            const real mass = state.rho * state.plane.area(), h = state.h[c], up = h + state.bed[c] - mean;
            if (moves) kinetic += 0.5 * mass * (state.qx[c] * state.qx[c] + state.qz[c] * state.qz[c]) / h;
            potential += mass * state.g * (moves ? h * (state.bed[c] + 0.5 * h) : 0.5 * up * up);
        }
        EXPECT_NEAR(value(*solver, "potential_energy"), potential, 1e-12 * potential) << model;
        if (moves) {
            EXPECT_NEAR(value(*solver, "kinetic_energy"), kinetic, 1e-12 * kinetic);
        }
    }
}

TEST("the advised step sees how fast waves cross columns along x and along z together") {
    const auto scene = waves("time.cfl = 0.4\n");
    const State state(scene);
    real most = 0;
    for (std::size_t c = 0; c < state.plane.count(); ++c) {
        const real h = state.h[c], wave = std::sqrt(state.g * h);
        most = std::max(most, (std::abs(state.qx[c]) / h + wave) / state.plane.dx + (std::abs(state.qz[c]) / h + wave) / state.plane.dz);
    }
    EXPECT_NEAR(test::height_solver(scene)->advised_dt(), 0.4 / most, 1e-12);
}

TEST("a side of a prescribed level over a bed is at rest beside water of that level") {
    const Side side{.kind = SideKind::level, .value = 0.3};
    const Beside b = beside(side, {0.2, 0, 0}, 0.1, 9.81);
    EXPECT_NEAR(b.h, 0.2, 1e-15);
    EXPECT_NEAR(b.out, 0, 1e-15);
}

TEST("a prescribed discharge comes in against the invariant from inside: 2 sqrt(g h) - q/h = out + 2 c") {
    const Side side{.kind = SideKind::discharge, .value = 0.05};
    for (const real out : {-0.2, 0.0, 0.3}) {
        const Beside b = beside(side, {0.2, out, 0}, 0, 9.81);
        EXPECT_NEAR(b.h * b.out, -0.05, 1e-14);
        EXPECT_NEAR(2 * std::sqrt(9.81 * b.h) + b.out, out + 2 * std::sqrt(9.81 * 0.2), 1e-13);
    }
}

TEST("an inflow pours as much through the upper side as through the lower one") {
    const auto net_inflow = [](const std::string& side, real u) {
        const auto solver = test::height_solver(scene::parse(
            fmt::format("solver = \"heightfield\"\ndim = 2\ngrid.cells = [20, 1]\ngrid.size = [1.0, 1.0]\ntime.end = 1.0\n"
                        "effects.gravity.g = [0.0, -9.81]\ninitial.surface = \"0.2\"\nsides.{} = {{ kind = \"inflow\", velocity = "
                        "[{}, 0.0] }}\n",
                        side, u),
            "inflow.toml", {heightfield::kind().schema}));
        for (int i = 0; i < 20; ++i) solver->step(0.005);
        return value(*solver, "poured_volume");
    };
    EXPECT_GT(net_inflow("x_min", 0.1), 1e-4);
    EXPECT_NEAR(net_inflow("x_max", -0.1), net_inflow("x_min", 0.1), 1e-14);
}

}  // namespace effects_tests
