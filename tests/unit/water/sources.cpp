// Emitters and open sides: what is poured, what drains, and the balance of volume that the surface is held to.
#include "support.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace sources_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// A tank whose side `open` is open, with an emitter, a ball that pours towards +x until `end`.
template <int D>
std::string poured_tank(const std::string& transfer, const std::string& open, const std::string& liquid) {
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 5.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {} ]
sides = {{ {} = "outflow" }}
emitters = [ {{ shape = "sphere", centre = {}, radius = 0.1, velocity = {}, end = 1.0 }} ]
effects = {{ gravity = {{ g = {} }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, D == 2 ? "[48, 32]" : "[24, 16, 16]", list({"1.5", "1.0", "1.0"}, D), liquid, open,
                       list({"0.3", "0.7", "0.5"}, D), list({"1.0", "0.0", "0.0"}, D), list({"0.0", "-9.81", "0.0"}, D), transfer);
}

/// What a ball of radius r pours in `t` at 1 m/s: itself, and then what passes through its cross-section.
template <int D>
real poured(real r, real t) {
    return D == 2 ? pi * r * r + 2 * r * t : 4 * pi / 3 * r * r * r + pi * r * r * t;
}

}  // namespace

TEST_IN_2D_AND_3D("an emitter fills, an open side drains, and surface and markers agree with the volume balance") {
    const real start = (D == 2 ? 1.5 : 1.5 * 1.0) * 0.1, most = start + poured<D>(0.1, 1.0);
    for (const std::string& transfer : D == 2 ? std::vector<std::string>{"flip", "apic"} : std::vector<std::string>{"flip"}) {
        const std::string layer =
            "{ shape = \"box\", min = " + list({"0.0", "0.0", "0.0"}, D) + ", max = " + list({"1.5", "0.1", "1.0"}, D) + " }";
        water::Water<D> water(water_scene(poured_tank<D>(transfer, "x_max", layer), {{"effects.volume_control", "{}"}}));
        real last = most, worst = 0;
        while (water.time() < 3) {
            water.step(water.advised_dt());
            const real balance = integral(water, "volume_target");
            ASSERT_GT(balance, 0) << transfer;
            ASSERT_LT(balance, 1.02 * most) << transfer;
            if (water.time() > 1.1) {
                ASSERT_LE(balance, last) << transfer << ": nothing pours any more";
                last = balance;
            }
            const real airborne = water.markers().volume * static_cast<real>(water.surface().count_airborne(water.markers()));
            worst = std::max(worst, std::abs(integral(water, "surface_volume") + airborne - balance));
        }
        EXPECT_LT(worst, 0.05 * most) << transfer << ": volume control moves the surface by 2% of a cell a step";
        EXPECT_LT(last, 0.9 * start) << transfer << ": the layer flows out";
    }
}

TEST_IN_2D_AND_3D("an emitter pours its cross-section times its speed, and what falls out of the tank leaves nothing behind") {
    for (const std::string transfer : {"grid", "flip"}) {
        water::Water<D> water(water_scene(poured_tank<D>(transfer, "y_min", "")));
        while (water.time() < 0.3) water.step(water.advised_dt());  // it takes 0.35 s to fall to the bottom
        // A ball's cross-section is that of half cells: right to half of one along the rim, averaged over the rim's many.
        EXPECT_NEAR(integral(water, "volume_target") / poured<D>(0.1, water.time()), 1, 0.05) << transfer;
        while (water.time() < 2.5) water.step(water.advised_dt());
        EXPECT_EQ(integral(water, "markers"), 0) << transfer;
        // Rests of less than 1e-6 of a cell are not handed on, here over the thousand cells that the jet has passed.
        EXPECT_NEAR(integral(water, "volume_target") / poured<D>(0.1, 2.5), 0, 1e-5) << transfer;
    }
}

}  // namespace sources_tests
