// Energy that comes from nowhere, on histories whose energy is known.
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <cmath>

namespace energy_tests {

using namespace weir;
using namespace weir::validation;

namespace {

constexpr real g = 9.81, density = 1000, depth = 0.5;
constexpr real at_rest = density * g * depth * depth / 2;  // [J/m] of water of this depth in a tank of one metre, above its floor

/// A tank of one metre whose floor is at y = 2, half full, and the energies of its water at each time.
RunRecord record(const std::string& rest, const std::vector<real>& kinetic, const std::vector<real>& potential) {
    const std::string text =
        "solver = \"mac_water\"\ndim = 2\ngrid = { cells = [8, 8], size = [1.0, 1.0], origin = [0.0, 2.0] }\ntime = { end = 1.0 }\n"
        "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = [0.0, 2.0], max = [1.0, 2.5] } ]\n" +
        rest;
    RunRecord run;
    run.scene = std::make_shared<const scene::Scene>(scene::parse(text, "tank.toml", sim::schemas()));
    run.fields.grid = {.dim = 2, .cells = {8, 8, 1}, .origin = {0, 2, 0}, .spacing = {0.125, 0.125, 0}};
    run.integrals = {{"volume", "m^2", depth}, {"kinetic_energy", "J/m", 0}, {"potential_energy", "J/m", 0}};
    for (std::size_t i = 0; i < kinetic.size(); ++i)
        run.history.push_back(
            {.step = static_cast<std::int64_t>(i), .time = 0.1 * real(i), .integrals = {depth, kinetic[i], potential[i]}});
    return run;
}

const std::string down = "effects = { gravity = { g = [0.0, -9.81] } }\n";

real gain(const std::vector<real>& kinetic, const std::vector<real>& potential, const std::string& rest = down) {
    return measure("energy_gain", record(rest, kinetic, potential), {});
}

}  // namespace

TEST("water at rest gains nothing; a rise counts in parts of its energy above the floor, whichever way gravity points") {
    EXPECT_EQ(gain({0, 0, 0}, {at_rest, at_rest, at_rest}), 0);
    EXPECT_NEAR(gain({0, 0.01 * at_rest, 0}, {at_rest, at_rest, at_rest}), 0.01, 1e-12);
    // Under gravity upwards the ceiling is lowest, and the water's middle is 3/4 m above it; its potential energy is counted from the
    // floor.
    const real middle = depth / 2, from_floor = -density * depth * g * middle, above = density * depth * g * (1 - middle);
    EXPECT_NEAR(gain({0, 1}, {from_floor, from_floor}, "effects = { gravity = { g = [0.0, 9.81] } }\n"), 1 / above, 1e-12);
}

TEST("a block in free fall gains nothing while its potential energy becomes kinetic") {
    std::vector<real> kinetic, potential;
    const real mass = density * depth;
    for (int i = 0; i < 10; ++i) {
        const real t = 0.02 * i;
        kinetic.push_back(mass * g * g * t * t / 2);
        potential.push_back(mass * g * (0.5 - g * t * t / 2));
    }
    EXPECT_LT(gain(kinetic, potential), 1e-14) << "round-off of ten sums";
}

TEST("what is won after a loss counts from the least before it, not from the first: dissipation does not pay for it") {
    // 100%, 60%, 75%, 70%, 80%: 20% were won after 60%, though nothing ever rose above the first
    EXPECT_NEAR(gain({0, 0, 0, 0, 0}, {at_rest, 0.6 * at_rest, 0.75 * at_rest, 0.7 * at_rest, 0.8 * at_rest}), 0.2, 1e-12);
    EXPECT_TRUE(std::isnan(gain({0, std::nan("")}, {at_rest, at_rest})));
}

TEST("where something does work that no integral counts, energy is not claimed") {
    const auto refusal = [](const std::string& rest) -> std::string {
        try {
            (void)gain({0}, {at_rest}, down + rest);
        } catch (const BadInput& bad) {
            return bad.what();
        }
        return "accepted";
    };
    EXPECT_NE(
        refusal("emitters = [ { shape = \"sphere\", centre = [0.5, 2.8], radius = 0.1, velocity = [0.0, -1.0] } ]\n").find("emitters"),
        std::string::npos);
    EXPECT_NE(refusal("sides = { x_max = \"outflow\" }\n").find("open"), std::string::npos);
    EXPECT_EQ(refusal("solids = [ { shape = \"sphere\", centre = [0.5, 2.8], radius = 0.1 } ]\n"), "accepted");
}

}  // namespace energy_tests
