// Every kind of probe on every real solver against a field that is known exactly: inside a cell, on its face, on its edge, at a wall, in a
// corner, in the air. Errors are round-off, but for what a solver itself leaves, which the test names.
#include "sim/simulation.hpp"

#include "sim/registry.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

namespace exact_probes_tests {

namespace {

using weir::real;
using weir::Simulation;

/// The same scene in 2D and 3D: "<x>" is x along every further axis.
std::string list(int dim, const std::string& x, const std::string& y, const std::string& z) {
    return '[' + x + ", " + y + (dim == 3 ? ", " + z : "") + ']';
}

/// A box of 1 m of so many cells a side; `probes` are its entries.
Simulation simulate(int dim, const std::string& solver, const std::string& rest, const std::vector<std::string>& probes,
                    const char* cells = "8") {
    std::string entries;
    for (std::size_t i = 0; i < probes.size(); ++i) entries += fmt::format("{{ name = \"p{}\", {} }}, ", i, probes[i]);
    return Simulation(weir::scene::parse(fmt::format("solver = \"{}\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\nprobes = [ {} ]\n{}",
                                                     solver, dim, list(dim, cells, cells, cells), list(dim, "1", "1", "1"), entries, rest),
                                         "exact.toml", weir::sim::schemas()));
}

real last(const Simulation& simulation, std::size_t probe, std::size_t column = 0) {
    return simulation.probe_series("p" + std::to_string(probe)).values.back()[column];
}

/// Inside a cell, on a face, on an edge (in 2D a corner of cells), at walls, in a corner of the box.
struct Place {
    const char *x, *y, *z;
    real at[3];
};
const std::vector<Place>& places() {
    static const std::vector<Place> all = {{"0.33", "0.21", "0.61", {0.33, 0.21, 0.61}},
                                           {"0.375", "0.3125", "0.5625", {0.375, 0.3125, 0.5625}},
                                           {"0.375", "0.25", "0.625", {0.375, 0.25, 0.625}},
                                           {"0.0", "0.21", "0.61", {0, 0.21, 0.61}},
                                           {"1.0", "0.25", "0.0", {1, 0.25, 0}},
                                           {"0.0", "0.0", "0.0", {0, 0, 0}}};
    return all;
}

const std::string gravity_of(int dim) { return "effects.gravity = { g = " + list(dim, "0", "-10", "0") + " }\n"; }

TEST_IN_2D_AND_3D("points and lines give a linear field exactly, also at walls and in corners; its integral is its mean times the volume") {
    std::vector<std::string> probes;
    for (const Place& p : places()) probes.push_back("kind = \"point\", field = \"temperature\", at = " + list(D, p.x, p.y, p.z));
    probes.push_back("kind = \"line\", field = \"temperature\", from = " + list(D, "0", "0", "0") + ", to = " + list(D, "1", "1", "1"));
    probes.push_back("kind = \"integral\", field = \"temperature\"");
    const std::string field = "initial.temperature = { name = \"linear\", value = 3.0, gradient = " + list(D, "2", "-1", "0.5") +
                              ", at = " + list(D, "0", "0", "0") + " }\n";
    for (const std::string solver : {"mac", "transport"}) {
        const std::string rest = solver == "mac" ? "effects.diffusion = { temperature = 0.1 }\n"
                                                 : "flow = { name = \"constant\", value = " + list(D, "0", "0", "0") + " }\n";
        const auto simulation = simulate(D, solver, "time = { end = 1 }\n" + field + rest, probes);
        const auto exact = [](const real* x) { return 3 + 2 * x[0] - x[1] + (D == 3 ? 0.5 * x[2] : 0); };
        for (std::size_t i = 0; i < places().size(); ++i) EXPECT_NEAR(last(simulation, i), exact(places()[i].at), 1e-13) << solver << i;
        const std::size_t line = places().size();
        for (std::size_t i = 0; i < 64; ++i) {
            const real s = static_cast<real>(i) / 63, x[3] = {s, s, s};
            EXPECT_NEAR(last(simulation, line, i), exact(x), 1e-13) << solver;
        }
        EXPECT_NEAR(last(simulation, line + 1), D == 3 ? 3.75 : 3.5, 1e-13) << solver;
    }
}

TEST_IN_2D_AND_3D("gauges stand on water at rest, and fronts on a block of it, at every place across the cells") {
    std::vector<std::string> probes;
    for (const Place& p : places()) probes.push_back("kind = \"gauge\", at = " + list(D, p.x, p.y, p.z));
    probes.push_back("kind = \"front\", axis = \"y\"");
    // The level set has the plane to round-off; a lattice of particles half a spacing below it; PBF settles, by less than a thousandth of a
    // spacing in a layer whose lattice is what its kernel sums to.
    const std::vector<std::pair<std::string, std::string>> solvers = {{"mac_water", ""}, {"sph", ""}, {"pbf", "scheme.settle = 0\n"}};
    for (const auto& [solver, rest] : solvers) {
        const auto simulation = simulate(D, solver,
                                         "time = { end = 1 }\nliquid = [ { shape = \"box\", min = " + list(D, "0", "0", "0") +
                                             ", max = " + list(D, "1", "0.5", "1") + " } ]\n" + rest,
                                         probes);
        for (std::size_t i = 0; i < places().size(); ++i) {
            EXPECT_NEAR(last(simulation, i, 0), 0.5, 1e-10) << solver << " height " << i;
            EXPECT_NEAR(last(simulation, i, 1), 0.5, 1e-10) << solver << " depth " << i;
        }
        EXPECT_NEAR(last(simulation, places().size()), 0.5, 1e-10) << solver << " front";
    }
}

TEST_IN_2D_AND_3D("a drop in the air is the height of a gauge and not its depth; a dry gauge reads nothing") {
    const std::vector<std::string> probes = {"kind = \"gauge\", at = " + list(D, "0.25", "0", "0.5"),
                                             "kind = \"gauge\", at = " + list(D, "0.9", "0", "0.9")};
    for (const std::string solver : {"mac_water", "sph", "pbf"}) {
        const std::string layer = "{ shape = \"box\", min = " + list(D, "0", "0", "0") + ", max = " + list(D, "0.625", "0.25", "1") + " }";
        const std::string drop =
            "{ shape = \"box\", min = " + list(D, "0.125", "0.5", "0.25") + ", max = " + list(D, "0.375", "0.75", "0.75") + " }";
        const auto simulation = simulate(
            D, solver, "time = { end = 1 }\nliquid = [ " + layer + ", " + drop + " ]\n" + (solver == "pbf" ? "scheme.settle = 0\n" : ""),
            probes);
        EXPECT_NEAR(last(simulation, 0, 0), 0.75, 1e-10) << solver;
        EXPECT_NEAR(last(simulation, 0, 1), 0.5, 1e-10) << solver;
        EXPECT_NEAR(last(simulation, 1, 0), 0, 1e-10) << solver;
        EXPECT_NEAR(last(simulation, 1, 1), 0, 1e-10) << solver;
    }
}

TEST_IN_2D_AND_3D("the pressure on walls below water at rest is rho g depth, on floor, side and corner, and nothing in the air") {
    const std::vector<std::string> probes = {"kind = \"wall_pressure\", at = " + list(D, "0.4", "0.0", "0.5"),
                                             "kind = \"wall_pressure\", at = " + list(D, "0.0", "0.25", "0.5"),
                                             "kind = \"wall_pressure\", at = " + list(D, "1.0", "0.2", "0.43"),
                                             "kind = \"wall_pressure\", at = " + list(D, "0.0", "0.0", "0.0"),
                                             "kind = \"wall_pressure\", at = " + list(D, "1.0", "0.9", "0.5"),
                                             "kind = \"wall_pressure\", at = " + list(D, "0.43", "1.0", "0.5")};
    const real expected[] = {5000, 2500, 3000, 5000, 0, 0};
    const std::string water = "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = " + list(D, "0", "0", "0") +
                              ", max = " + list(D, "1", "0.5", "1") + " } ]\n" + gravity_of(D);
    // mac_water solves to 1e-10 of the right-hand side; SPH's first pressure is the hydrostatic one, in double precision.
    auto grid = simulate(D, "mac_water", "time = { end = 1, dt = 0.001 }\nscheme.poisson = { tolerance = 1e-12 }\n" + water, probes);
    grid.step();
    const auto particles = simulate(D, "sph", "time = { end = 1 }\ninitial.surface = " + list(D, "0", "0.5", "0") + "\n" + water, probes);
    for (std::size_t i = 0; i < probes.size(); ++i) {
        EXPECT_NEAR(last(grid, i), expected[i], 1e-3) << "mac_water " << i;
        EXPECT_NEAR(last(particles, i), expected[i], 1e-6) << "sph " << i;
    }
}

TEST_IN_2D_AND_3D("fluid that fills its box presses on a ball by its depth; the constant is the mean that is zero") {
    const std::vector<std::string> probes = {"kind = \"wall_pressure\", at = " + list(D, "0.5", "0.0", "0.5"),
                                             "kind = \"wall_pressure\", at = " + list(D, "0.5", "1.0", "0.5")};
    auto simulation = simulate(
        D, "mac", "time = { end = 1, dt = 0.001 }\nfluid = { density = 1000.0 }\nscheme.poisson = { tolerance = 1e-12 }\n" + gravity_of(D),
        probes);
    simulation.step();
    EXPECT_NEAR(last(simulation, 0) - last(simulation, 1), 10000, 1e-3);
}

TEST_IN_2D_AND_3D("a wall that only one layer of liquid touches feels no less than nothing") {
    const std::vector<std::string> probes = {"kind = \"wall_pressure\", at = " + list(D, "0.4", "0.0", "0.5")};
    const std::string film = "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = " + list(D, "0", "0", "0") +
                             ", max = " + list(D, "1", "0.2", "1") + " } ]\n" + gravity_of(D);
    auto simulation = simulate(D, "mac_water", "time = { end = 1, dt = 0.001 }\n" + film, probes);
    simulation.step();
    EXPECT_GE(last(simulation, 0), 0.0);
    EXPECT_LE(last(simulation, 0), 2000.1);  // rho g 0.2 m, and what the solve leaves
}

// The momentum that a slab of liquid brings to a wall is what gauges along that wall add up to over the time. Each sees the particles by a
// window whose sum over a disordered set differs from its integral by some per cent: 10%. A fit that is extrapolated to the wall, from the
// few particles that touch it first, reads more than twice as much.
TEST("gauges on a wall that a slab of particles hits add up to the momentum that the wall takes") {
    std::vector<std::string> probes;
    for (int i = 0; i < 32; ++i) probes.push_back(fmt::format("kind = \"wall_pressure\", at = [1.0, {}]", (i + 0.5) / 32));
    probes.emplace_back("kind = \"integral\", field = \"momentum_x\"");
    auto simulation = simulate(2, "sph",
                               "time = { end = 0.25 }\nfluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = [0.7, 0.375], "
                               "max = [0.8, 0.625] } ]\ninitial.velocity = { name = \"constant\", value = [1.0, 0.0] }\n",
                               probes, "32");
    while (!simulation.finished()) simulation.step();
    real impulse = 0;
    for (std::size_t i = 0; i < 32; ++i) {
        const auto& series = simulation.probe_series("p" + std::to_string(i));
        for (std::size_t k = 1; k < series.times.size(); ++k)
            impulse += (series.times[k] - series.times[k - 1]) * (series.values[k][0] + series.values[k - 1][0]) / 2 / 32;
    }
    const auto& momentum = simulation.probe_series("p32").values;
    ASSERT_GT(momentum.front()[0] - momentum.back()[0], 0.5 * momentum.front()[0]);
    EXPECT_NEAR(impulse / (momentum.front()[0] - momentum.back()[0]), 1, 0.1);
}

}  // namespace

TEST("a gauge's height is above the domain's floor, wherever that lies") {
    Simulation water(
        weir::scene::parse("solver = \"mac_water\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1], origin = [0, -2] }\n"
                           "time = { end = 1, dt = 0.001 }\nliquid = [ { shape = \"box\", min = [0, -2], max = [1, -1.5] } ]\n"
                           "effects.gravity.g = [0.0, -9.81]\nprobes = [ { name = \"p0\", kind = \"gauge\", at = [0.4, -1.9] } ]\n",
                           "floor.toml", weir::sim::schemas()));
    water.run_until(0.002);
    EXPECT_NEAR(last(water, 0), 0.5, 1e-9);  // still water stays still to the pressure's tolerance
}

}  // namespace exact_probes_tests
