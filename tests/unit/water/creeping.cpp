// Liquids so thick that weight, pressure and friction balance within a step: blocks of honey that slump.
#include "support.hpp"

#include <array>

namespace weir::water::creeping_tests {

namespace {

/// A block twice as wide as high (in 3D as long, too) on a no-slip floor: 10 cm high in cells of 6.25 mm, or of 12.5 mm in 3D.
template <int D>
std::string block(real nu, const std::string& scheme, const std::string& transfer, real shift = 0) {
    const auto at = [&](real x) { return fmt::format("{:.17g}", x); };
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 0.15 }}
fluid = {{ density = 1400.0, viscosity = {} }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
sides = {{ y_min = {{ kind = "wall", slip = "no" }} }}
effects = {{ gravity = {{ g = {} }}, viscosity = {{ scheme = "{}" }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, D == 2 ? "[32, 32]" : "[16, 16, 16]", test::list({"0.2", "0.2", "0.2"}, D), nu,
                       test::list({at(0.05 + shift), "0.0", "0.05"}, D), test::list({at(0.15 + shift), "0.1", "0.15"}, D),
                       test::list({"0.0", "-9.81", "0.0"}, D), scheme, transfer);
}

/// By how much less energy of position there is after `time` [J/m, J], with steps of at most max_dt.
template <int D>
real fallen(const std::string& scene, real time, real max_dt = infinity) {
    Water<D> water(test::water_scene(scene));
    const real start = test::integral(water, "potential_energy");
    while (water.time() < time * (1 - 1e-9)) water.step(std::min({water.advised_dt(), max_dt, time - water.time()}));
    return start - test::integral(water, "potential_energy");
}

}  // namespace

// 5% is what was asked for. The surface moves by the previous velocity, so that a step's lag is left of 150 ms: 3% where dt is 14 ms and
// begins small. Were the weight to fall freely within a step, and friction to act on the next, the default step's block would fall 13 times
// as far at ν = 1 and twice as far at ν = 0.1.
TEST("a thick block slumps as far by the default step as by small ones") {
    set_threads(1);
    for (const real nu : {1.0, 0.1, 0.01})
        for (const char* transfer : {"flip", "apic"})
            EXPECT_NEAR(fallen<2>(block<2>(nu, "implicit", transfer), 0.15) / fallen<2>(block<2>(nu, "implicit", transfer), 0.15, 1e-3), 1,
                        0.05)
                << "nu " << nu << ", " << transfer;
}

// As above; cells are twice as large, and so is the step's square: 4% of lag.
TEST("a thick block slumps as far by the default step in 3D, too") {
    set_threads(1);
    EXPECT_NEAR(fallen<3>(block<3>(1, "implicit", "flip"), 0.1) / fallen<3>(block<3>(1, "implicit", "flip"), 0.1, 2e-3), 1, 0.05);
}

// A side that cuts cells in their middles and one between cells differ at first order in the cell: a quarter of one at either side of 16 is
// 3% of the width, of which the rate is about the third power. Whole cells change the markers' jitter alone, a hundredth of one nothing.
TEST("a thick block slumps as far wherever it stands on the grid") {
    set_threads(1);
    const real here = fallen<2>(block<2>(1, "implicit", "flip"), 0.1);
    for (const auto& [part, bound] : {std::pair{0.01, 0.01}, std::pair{0.5, 0.1}, std::pair{1.0, 0.01}})
        EXPECT_NEAR(fallen<2>(block<2>(1, "implicit", "flip", part * 0.2 / 32), 0.1) / here, 1, bound) << part;
}

// A creeping block has the velocity of its shape, which changes by a hundredth in a step; a scheme that does not damp swings by a factor of
// 10 from step to step. The first steps, until 30 ms, set it in motion.
TEST("friction of thick liquid does not swing from step to step") {
    set_threads(1);
    for (const char* scheme : {"crank-nicolson", "implicit"}) {
        Water<2> water(test::water_scene(block<2>(1, scheme, "flip")));
        while (water.time() < 0.03) water.step(water.advised_dt());
        real before = test::integral(water, "kinetic_energy");
        while (water.time() < 0.15) {
            water.step(water.advised_dt());
            const real now = test::integral(water, "kinetic_energy");
            EXPECT_NEAR(now / before, 1, 0.1) << scheme << " at " << water.time();
            before = now;
        }
    }
}

// The first turn after a start has no pressure to begin from; later ones find the last one nearly right, or it would cost a pressure solve
// more in every step.
TEST("a creeping block takes one solve a step, once it creeps") {
    set_threads(1);
    Water<2> water(test::water_scene(block<2>(1, "implicit", "flip")));
    while (water.time() < 0.03) water.step(water.advised_dt());
    int turns = 0;
    for (int i = 0; i < 8; ++i) turns += water.step(water.advised_dt()).viscous_coupling_iterations;
    EXPECT_LE(turns, 1);
}

}  // namespace weir::water::creeping_tests
