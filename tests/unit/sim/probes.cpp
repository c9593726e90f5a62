#include "sim/probes.hpp"

#include "sim/registry.hpp"
#include "support/fake_solver.hpp"
#include "support/test.hpp"

#include <cmath>

namespace probes_tests {

namespace {

using weir::real;
using weir::test::fake_simulation;
using weir::test::FakeSolver;

std::string probe(const std::string& entry) { return "time = { end = 0.2 }\nprobes = [ { name = \"p\", " + entry + " } ]"; }

TEST_IN_2D_AND_3D("a point between samples of a linear field gives the field: bilinear interpolation is exact there, to round-off") {
    const std::string at = D == 2 ? "[0.33, 0.71]" : "[0.33, 0.71, 0.21]";
    auto simulation = fake_simulation(probe("kind = \"point\", field = \"velocity\", at = " + at), D);
    simulation.step();
    const auto& series = simulation.probe_series("p");
    ASSERT_EQ(series.columns.size(), static_cast<std::size_t>(D));
    EXPECT_EQ(series.columns[1], "velocity_y [m/s]");
    const real x[3] = {0.33, 0.71, 0.21};
    for (int a = 0; a < D; ++a)
        EXPECT_NEAR(series.values[1][static_cast<std::size_t>(a)], FakeSolver::velocity(a, x[a], simulation.time()), 1e-14);
}

TEST("a line samples both its ends and evenly between them") {
    auto simulation = fake_simulation(probe("kind = \"line\", field = \"pressure\", from = [0.2, 0.3], to = [0.8, 0.7], count = 4"));
    const auto& series = simulation.probe_series("p");
    ASSERT_EQ(series.values[0].size(), 4u);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(series.values[0][i], FakeSolver::pressure(series.positions[i][0], series.positions[i][1]), 1e-14);
    EXPECT_NEAR(series.positions[3][0], 0.8, 1e-15);
}

TEST_IN_2D_AND_3D("a gauge finds the plane surface exactly, as linear interpolation must") {
    auto simulation = fake_simulation(probe(std::string("kind = \"gauge\", at = ") + (D == 2 ? "[0.3, 0]" : "[0.3, 0, 0.5]")), D);
    simulation.run_until(0.1);
    EXPECT_NEAR(simulation.probe_series("p").values.back()[0], FakeSolver::surface(0.3, 0.1), 1e-14);
}

TEST("a gauge reads the height above the domain's floor, wherever the floor is") {
    weir::Simulation simulation(
        weir::scene::parse("solver = \"fake\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1], origin = [0, -0.25] }\n" +
                               probe("kind = \"gauge\", at = [0.3, 0]"),
                           "fake.toml", {weir::test::fake_kinds()[0].schema}),
        weir::test::fake_kinds());
    EXPECT_NEAR(simulation.probe_series("p").values[0][0], FakeSolver::surface(0.3, 0) + 0.25, 1e-14);
}

TEST("the front along x is the domain's end, half a cell beyond the last centre, where the outermost cells are liquid") {
    auto simulation = fake_simulation(probe("kind = \"front\", axis = \"x\""));
    EXPECT_NEAR(simulation.probe_series("p").values[0][0], 1.0, 1e-15);
}

TEST("wall pressure is fitted to the liquid beside the wall: exact for a linear pressure, half a cell beyond the last centre") {
    auto simulation = fake_simulation(probe("kind = \"wall_pressure\", at = [1.0, 0.2]"));
    EXPECT_NEAR(simulation.probe_series("p").values[0][0], FakeSolver::pressure(1.0, 0.2), 1e-12);  // round-off of a fit of 3 numbers
}

TEST("wall pressure on a body is fitted to the liquid beside it") {
    auto simulation = fake_simulation(probe("kind = \"wall_pressure\", at = [0.31, 0.2]") +
                                      "\nsolids = [ { shape = \"sphere\", centre = [0.2, 0.2], radius = 0.1 } ]");
    EXPECT_NEAR(simulation.probe_series("p").values[0][0], FakeSolver::pressure(0.3, 0.2), 1e-10);  // eps of the normal is 1e-3 cells
}

TEST("an integral is the solver's own by name, or a cell field summed times the volume of its cells") {
    auto own = fake_simulation(probe("kind = \"integral\", field = \"mass\""));
    EXPECT_EQ(own.probe_series("p").columns[0], "mass [kg]");
    EXPECT_EQ(own.probe_series("p").values[0][0], 1.3);
    auto field = fake_simulation(probe("kind = \"integral\", field = \"pressure\""));
    EXPECT_NEAR(field.probe_series("p").values[0][0], 0.5, 1e-14);  // the integral of 3 x - 2 y over the unit square
}

TEST("a probe has rows at the multiples of its interval, between steps too, and steps are not shortened for it") {
    auto simulation = fake_simulation(
        "time = { end = 0.1, dt = 0.01 }\nprobes = [ { name = \"p\", kind = \"integral\", field = \"mass\", every = 0.025 } ]");
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.steps(), 10);
    EXPECT_EQ(simulation.probe_series("p").times, (std::vector<real>{0, 0.025, 0.05, 0.075, 0.1}));
}

TEST("a probe of what the solver does not have is refused, with the fields that there are") {
    try {
        fake_simulation(probe("kind = \"point\", field = \"smoke\", at = [0.5, 0.5]"));
        FAIL() << "accepted";
    } catch (const weir::scene::BadScene& bad) {
        EXPECT_NE(std::string(bad.what()).find("has no field \"smoke\""), std::string::npos) << bad.what();
        EXPECT_NE(std::string(bad.what()).find("velocity, pressure, level_set"), std::string::npos) << bad.what();
    }
}

TEST("a probe outside the domain, twice the same name, and a name that is no file name are refused") {
    EXPECT_THROW(fake_simulation(probe("kind = \"point\", field = \"pressure\", at = [1.5, 0.5]")), weir::scene::BadScene);
    const std::string p = "{ name = \"a\", kind = \"front\" }";
    EXPECT_THROW(fake_simulation("time = { end = 1 }\nprobes = [ " + p + ", " + p + " ]"), weir::scene::BadScene);
    EXPECT_THROW(fake_simulation("time = { end = 1 }\nprobes = [ { name = \"../a\", kind = \"front\" } ]"), weir::scene::BadScene);
}

/// Steps of 0.01 to 0.03 s, none of which ends at a multiple of 0.025 s.
const std::string in_time =
    "time = { end = 1.0 }\nprobes = [ { name = \"v\", kind = \"point\", field = \"velocity\", at = [0.33, 0.71], every = ";

TEST("rows of a probe with an interval are at its times exactly, and linear in time between the steps around each of them") {
    for (const real every : {0.1, 0.025, 0.002, 0.3}) {  // seldom, about every step, several times in a step, and the end is no multiple
        auto simulation = fake_simulation(in_time + std::to_string(every) + " } ]");
        while (!simulation.finished()) simulation.step();
        const auto& series = simulation.probe_series("v");
        ASSERT_EQ(series.times.size(), static_cast<std::size_t>(std::floor(1 / every + 1e-9)) + 1) << every;
        for (std::size_t k = 0; k < series.times.size(); ++k) {
            EXPECT_EQ(series.times[k], std::round(1000 * every) * static_cast<real>(k) / 1000) << every;
            // the velocity there is linear in time, so that interpolation is exact to round-off
            EXPECT_NEAR(series.values[k][0], FakeSolver::velocity(0, 0.33, series.times[k]), 1e-14) << every;
        }
    }
}

TEST("a row lies between the values of the two steps around its time, in proportion: of a quantity that jumps from step to step too") {
    const std::string both =
        "{ name = \"all\", kind = \"integral\", field = \"mass\" }, { name = \"m\", kind = \"integral\", field = "
        "\"mass\", every = 0.035 }";
    auto simulation = fake_simulation("time = { end = 1.0 }\nprobes = [ " + both + " ]");
    while (!simulation.finished()) simulation.step();
    const auto &steps = simulation.probe_series("all"), &rows = simulation.probe_series("m");
    ASSERT_EQ(rows.times.size(), 29u);
    for (std::size_t k = 0; k < rows.times.size(); ++k) {
        std::size_t i = 0;
        while (i + 2 < steps.times.size() && steps.times[i + 1] < rows.times[k]) ++i;
        const real s = (rows.times[k] - steps.times[i]) / (steps.times[i + 1] - steps.times[i]);
        EXPECT_NEAR(rows.values[k][0], (1 - s) * steps.values[i][0] + s * steps.values[i + 1][0], 1e-14) << k;
    }
}

TEST("rows are bit for bit the same over a restart after any step, and a probe that begins later has the rows from there on") {
    const std::string scene = in_time + "0.035 } ]";
    auto whole = fake_simulation(scene), plain = fake_simulation("time = { end = 1.0 }");
    while (!whole.finished()) whole.step();
    const auto& expected = whole.probe_series("v");
    for (int steps = 0; steps < 12; ++steps) {
        auto first = fake_simulation(scene), second = fake_simulation(scene), late = fake_simulation(scene);
        for (int i = 0; i < steps; ++i) first.step();
        weir::Checkpoint state, without;
        first.save(state);
        second.restore(state);
        while (!second.finished()) second.step();
        EXPECT_EQ(second.probe_series("v").times, expected.times) << steps;
        EXPECT_EQ(second.probe_series("v").values, expected.values) << steps;
        plain.save(without);
        late.restore(without);
        while (!late.finished()) late.step();
        const auto& rest = late.probe_series("v");
        ASSERT_LT(rest.times.size(), expected.times.size() + 1);
        const std::size_t skipped = expected.times.size() - rest.times.size();
        for (std::size_t k = 0; k < rest.times.size(); ++k) {
            EXPECT_EQ(rest.times[k], expected.times[k + skipped]);
            EXPECT_EQ(rest.values[k], expected.values[k + skipped]);
        }
        EXPECT_GE(rest.times.front(), plain.time());
        EXPECT_LT(rest.times.front(), plain.time() + 0.035);
        plain.step();
    }
}

TEST("a change of a key between two steps does not move the row between them, and an edit begins it anew") {
    auto plain = fake_simulation(in_time + "0.1 } ]"), set = fake_simulation(in_time + "0.1 } ]");
    while (!plain.finished()) plain.step();
    while (!set.finished()) set.step(), set.set("time.cfl", 0.7);
    EXPECT_EQ(set.probe_series("v").values, plain.probe_series("v").values);
}

TEST("an interval with more rows than memory holds is refused") {
    try {
        fake_simulation(in_time + "1e-9 } ]");
        FAIL() << "taken";
    } catch (const weir::BadInput& refused) {
        EXPECT_NE(std::string(refused.what()).find("1e+09 rows"), std::string::npos) << refused.what();
    }
}

/// Smoke in a box of 1 m with a disc of 0.1 m at x = 0.3 that rests, or moves by 1 m/s.
weir::Simulation beside_disc(const std::string& probe, const std::string& motion) {
    const std::string text =
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [16, 16], size = [1, 1] }\ntime = { end = 0.3, dt = 0.02 }\n"
        "initial.velocity = { name = \"constant\", value = [0, 0] }\n"
        "solids = [ { shape = \"sphere\", centre = [0.3, 0.5], radius = 0.1" +
        motion + " } ]\nprobes = [ { name = \"p\", " + probe + " } ]\n";
    return weir::Simulation(weir::scene::parse(text, "disc.toml", weir::sim::schemas()));
}
const std::string moves = ", motion = { kind = \"constant\", velocity = [1.0, 0.0] }";

TEST("a probe inside a solid that does not move is refused; on its surface and beside it none is") {
    const auto refused = [](const std::string& probe, const std::string& motion) {
        try {
            beside_disc("field = \"pressure\", " + probe, motion);
            return std::string();
        } catch (const weir::BadInput& error) {
            return std::string(error.what());
        }
    };
    for (const std::string at : {"[0.3, 0.5]", "[0.39, 0.5]", "[0.25, 0.45]"})
        EXPECT_NE(refused("kind = \"point\", at = " + at, "").find("the probe is inside a solid that does not move"), std::string::npos)
            << refused("kind = \"point\", at = " + at, "");
    for (const std::string at : {"[0.4, 0.5]", "[0.3, 0.4]", "[0.41, 0.5]"}) EXPECT_EQ(refused("kind = \"point\", at = " + at, ""), "");
    EXPECT_NE(refused("kind = \"line\", from = [0.25, 0.5], to = [0.35, 0.5]", "").find("all points"), std::string::npos);
    EXPECT_EQ(refused("kind = \"point\", at = [0.3, 0.5]", moves), "");
}

TEST("a line through a solid has no number inside it, and numbers on both sides; that is said once") {
    auto simulation = beside_disc("kind = \"line\", field = \"pressure\", from = [0.05, 0.5], to = [0.55, 0.5], count = 11", "");
    while (!simulation.finished()) simulation.step();
    for (const auto& row : simulation.probe_series("p").values)
        for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ(std::isnan(row[i]), i >= 4 && i <= 6) << i;  // 0.25, 0.3 and 0.35 m
    ASSERT_EQ(simulation.warnings().size(), 1u);
    EXPECT_NE(simulation.warnings()[0].find("disc.toml: 3 of the 11 points of probe \"p\" lie inside solids"), std::string::npos)
        << simulation.warnings()[0];
}

TEST("a solid that moves over a probe leaves not a number while it covers it, between steps too, and that is said once with its time") {
    auto simulation = beside_disc("kind = \"point\", field = \"velocity\", at = [0.5, 0.5], every = 0.01", moves);
    while (!simulation.finished()) simulation.step();
    const auto& series = simulation.probe_series("p");
    ASSERT_EQ(series.times.size(), 31u);
    for (std::size_t k = 0; k < 31; ++k)  // the disc's edge is there at 0.1 s and leaves at 0.3 s
        EXPECT_EQ(std::isnan(series.values[k][0]), series.times[k] > 0.105 && series.times[k] < 0.295) << series.times[k];
    ASSERT_EQ(simulation.warnings().size(), 1u);
    EXPECT_NE(simulation.warnings()[0].find("probe \"p\" lies inside a solid at t = 0.12 s"), std::string::npos)
        << simulation.warnings()[0];
}

TEST_IN_2D_AND_3D("a gauge along any axis reads the depth of water that rests on that side, of particles and of grids") {
    for (int axis = 0; axis < D; ++axis)
        for (const std::string solver : {"mac_water", "tallcell", "sph", "pbf"}) {
            const auto vec = [&](auto&& f) {
                std::string list;
                for (int a = 0; a < D; ++a) list += (a == 0 ? "[" : ", ") + f(a);
                return list + "]";
            };
            const auto same = [](const char* value) { return [value](int) { return std::string(value); }; };
            const std::string text =
                "solver = \"" + solver + "\"\ndim = " + std::to_string(D) + "\ngrid = { cells = " + vec(same("8")) +
                ", size = " + vec(same("1")) + " }\ntime = { end = 1 }\nliquid = [ { shape = \"box\", min = " + vec(same("0")) +
                ", max = " + vec([&](int a) { return std::string(a == axis ? "0.5" : "1"); }) +
                " } ]\neffects.gravity.g = " + vec([&](int a) { return std::string(a == axis ? "-10" : "0"); }) +
                (solver == "pbf" ? "\nscheme.settle = 0" : "") + "\nprobes = [ { name = \"p\", kind = \"gauge\", axis = \"" + "xyz"[axis] +
                "\", at = " + vec(same("0.3")) + " } ]\n";
            const weir::Simulation simulation(weir::scene::parse(text, "axes.toml", weir::sim::schemas()));
            EXPECT_NEAR(simulation.probe_series("p").values[0][0], 0.5, 1e-10) << text;
            EXPECT_NEAR(simulation.probe_series("p").values[0][1], 0.5, 1e-10) << text;
        }
}

TEST_IN_2D_AND_3D("still water of particles stays as high as it is deep, and a symmetric collapse is never dry on its axis") {
    const bool flat = D == 2;
    const std::string ends = flat ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]", cells = flat ? "[20, 20]" : "[12, 12, 12]";
    const real spacing = flat ? 1.0 / 20 : 1.0 / 12;
    const auto run = [&](const std::string& solver, const std::string& liquid) {
        const std::string text = "solver = \"" + solver + "\"\ndim = " + std::to_string(D) + "\ngrid = { cells = " + cells +
                                 ", size = " + (flat ? "[1, 1]" : "[1, 1, 1]") +
                                 " }\ntime = { end = 0.6 }\nfluid.density = 1000\nliquid = [ " + liquid +
                                 " ]\neffects.gravity.g = " + (flat ? "[0, -9.81]" : "[0, -9.81, 0]") +
                                 "\nprobes = [ { name = \"g\", kind = \"gauge\", at = " + (flat ? "[0.5, 0.1]" : "[0.5, 0.1, 0.5]") +
                                 ", every = 0.1 }, { name = \"f\", kind = \"front\", every = 0.1 } ]\n";
        weir::Simulation simulation(weir::scene::parse(text, "column.toml", weir::sim::schemas()));
        while (!simulation.finished()) simulation.step();
        for (const auto& row : simulation.probe_series("f").values) EXPECT_LE(row[0], 1.0) << solver;
        return simulation.probe_series("g");
    };
    for (const std::string solver : {"sph", "pbf"}) {
        const auto still = run(solver, "{ shape = \"box\", min = " + ends + ", max = " + (flat ? "[1, 0.5]" : "[1, 0.5, 1]") + " }");
        ASSERT_EQ(still.values.size(), 7u);
        for (const auto& row : still.values) EXPECT_NEAR(row[0], 0.5, 0.5 * spacing) << solver;  // as near as particles tell a surface
        const auto falls = run(solver, std::string("{ shape = \"box\", min = ") + (flat ? "[0.25, 0]" : "[0.25, 0, 0.25]") +
                                           ", max = " + (flat ? "[0.75, 0.5]" : "[0.75, 0.5, 0.75]") + " }");
        for (std::size_t k = 0; k < 4; ++k) EXPECT_GT(falls.values[k][0], spacing) << solver << ' ' << k;
        for (std::size_t k = 1; k < 4; ++k) EXPECT_LT(falls.values[k][0], falls.values[k - 1][0] + 0.5 * spacing) << solver << ' ' << k;
    }
}

}  // namespace

}  // namespace probes_tests
