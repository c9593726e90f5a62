#include "sim/probes.hpp"

#include "support/fake_solver.hpp"
#include "support/test.hpp"

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

TEST("a probe is sampled at the start and at the first step at or after each multiple of its interval; steps are not cut for it") {
    auto simulation = fake_simulation(
        "time = { end = 0.1, dt = 0.01 }\nprobes = [ { name = \"p\", kind = \"integral\", field = \"mass\", every = 0.025 } ]");
    while (!simulation.finished()) simulation.step();
    const auto& times = simulation.probe_series("p").times;
    EXPECT_EQ(simulation.steps(), 10);
    const std::vector<real> expected{0, 0.03, 0.05, 0.08, 0.1};
    ASSERT_EQ(times.size(), expected.size());
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], expected[i], 1e-12);
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

}  // namespace
