// The conserved liquid part of cells: plane cuts, transport, and what scenes in which water breaks up keep of it.
#include "free_surface/plane_cut.hpp"
#include "free_surface/volume_fraction.hpp"
#include "support.hpp"

#include <cmath>
#include <string>

namespace volume_tests {

using namespace weir;
using namespace weir::test;
using namespace weir::free_surface;

namespace {

/// Directions that lie along axes, along diagonals, and anywhere.
template <int D>
std::vector<Vec<D>> directions() {
    std::vector<Vec<D>> list;
    for (int i = 1; i < (D == 2 ? 25 : 125); ++i) {
        Vec<D> g;
        for (int d = 0, rest = i; d < D; ++d, rest /= 5) g[d] = 0.5 * (rest % 5 - 2) + (i % 3 == 0 ? 0.013 * d : 0);
        real steep = 0;
        for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
        if (steep > 0) list.push_back(g);
    }
    return list;
}

/// Water over a plate with two holes, in a closed box.
template <int D>
std::string sieve(const std::string& transfer) {
    std::string plate;
    for (const auto& [from, to] : {std::pair{"-0.1", "0.1"}, {"0.2", "0.3"}, {"0.4", "0.6"}})
        plate += (plate.empty() ? "" : ", ") +
                 fmt::format("{{ shape = \"box\", min = {}, max = {} }}", list({from, "0.46", "-0.1"}, D), list({to, "0.56", "0.6"}, D));
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 2.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
solids = [ {} ]
effects = {{ gravity = {{ g = {} }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, list({"16", "32", "6"}, D), list({"0.5", "1.0", "0.1875"}, D), list({"0.0", "0.56", "0.0"}, D),
                       list({"0.5", "0.85", "0.1875"}, D), plate, list({"0.0", "-9.81", "0.0"}, D), transfer);
}

/// A tap that runs for 0.2 s in a box of 10 cm.
template <int D>
std::string tap(const std::string& transfer) {
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
emitters = [ {{ shape = "box", min = {}, max = {}, velocity = {}, end = 0.2 }} ]
effects = {{ gravity = {{ g = {} }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, list({"12", "12", "12"}, D), list({"0.1", "0.1", "0.1"}, D), list({"0.035", "0.08", "0.035"}, D),
                       list({"0.065", "0.095", "0.065"}, D), list({"0.0", "-0.5", "0.0"}, D), list({"0.0", "-9.81", "0.0"}, D), transfer);
}

}  // namespace

TEST_IN_2D_AND_3D("the plane that leaves a part of a cell below it leaves that part") {
    for (const Vec<D>& g : directions<D>())
        for (const real part : {1e-4, 0.03, 0.2, 0.45, 0.5, 0.61, 0.9, 0.999}) {
            const real value = plane_with_fraction(part, g);
            // 1e-8: an axis flatter than 1e-4 of the others is left out; the corners' sum cancels to 1e-12 over that squared or cubed
            EXPECT_NEAR(fraction_below_plane(value, g), part, D == 2 ? 1e-8 : 3e-8);
        }
}

TEST_IN_2D_AND_3D("slabs of a cell hold what the cell holds") {
    for (const Vec<D>& g : directions<D>())
        for (const real part : {0.1, 0.5, 0.8})
            for (int axis = 0; axis < D; ++axis) {
                const real value = plane_with_fraction(part, g);
                const real both = liquid_in_slab(value, g, axis, 0, 0.3) + liquid_in_slab(value, g, axis, 1, 0.7);
                EXPECT_NEAR(both, part, 3e-8);
            }
}

TEST_IN_2D_AND_3D("a corner cut off by a plane is a simplex") {
    Vec<D> g;
    for (int d = 0; d < D; ++d) g[d] = 1;
    // x + y (+ z) < a from the lower corner: a^D / D!
    const real a = 0.3, exact = D == 2 ? a * a / 2 : a * a * a / 6;
    EXPECT_NEAR(fraction_below_plane(real(0.5 * D) - a, g), exact, 1e-14);
    EXPECT_NEAR(plane_with_fraction(exact, g), real(0.5 * D) - a, 1e-12);
}

TEST_IN_2D_AND_3D("a sieve and a tap keep their volume, and the surface shows it") {
    for (const std::string transfer : {"flip", "apic", "pic", "grid"})
        for (const std::string& scene : {sieve<D>(transfer), tap<D>(transfer)}) {
            water::Water<D> water(water_scene(scene));
            const real end = water_scene(scene).number("time.end");
            while (water.time() < end) {
                water.step(water.advised_dt());
                const real target = integral(water, "volume_target");
                // Round-off of sums over 10^3 cells in 10^2 steps, 1e-16 each
                ASSERT_NEAR(integral(water, "volume"), target, 1e-10 * target + 1e-15) << transfer;
            }
            // What the surface encloses: 0.03 h that the two may differ by anywhere, on water that is some four cells deep, and spray
            const real target = integral(water, "volume_target");
            EXPECT_NEAR(integral(water, "surface_volume"), target, 0.05 * target) << transfer << " " << scene;
        }
}

TEST_IN_2D_AND_3D("liquid parts stay as they were where nothing moves") {
    Vec<D> point = Vec<D>::constant(0.5), normal = Vec<D>::unit(1);
    normal[0] = 0.2;
    water::Water<D> water(water_scene(at_rest<D>(point, normal, "flip")));
    const Grid<real, D> before = water.volume().part();
    for (int i = 0; i < 10; ++i) water.step(water.advised_dt());
    real most = 0;
    for (std::size_t i = 0; i < before.size(); ++i) most = std::max(most, std::abs(water.volume().part()[i] - before[i]));
    EXPECT_LT(most, 1e-8) << "the pressure's tolerance leaves 1e-10 m/s, in ten steps of 0.1 s over 0.06 m cells";
}

TEST_IN_2D_AND_3D("in a flow without divergence parts stay in [0, 1] and keep their sum to round-off") {
    const water::Water<D> water(water_scene(dam_break<D>()));
    mac::MacState<D> state = water.state();
    const Frame<D> frame(state.u, state.sides);
    const real h = frame.h_min();
    const auto stream = [&](const Index<D>& I) { return std::sin(pi * I[0] * h) * std::sin(pi * I[1] * h) / pi; };  // 0 on the walls
    for (int a = 0; a < D; ++a)
        for_each_cell(state.u[a].extent(), [&](const Index<D>& I) {
            const real change = a < 2 ? stream(I + e<D>(1 - a)) - stream(I) : 0;
            state.u[a](I) = a == 0 ? change / h : -change / h;
        });
    LiquidVolume<D> volume(frame);
    volume.start(water.surface(), state);
    const real before = volume.volume();
    for (int step = 0; step < 60; ++step) volume.advect(state, water.surface().phi, 0.24 * h, step % 2 == 1);
    EXPECT_NEAR(volume.volume(), before, 1e-13) << "sums of 3000 cells in 60 steps, 1e-16 of the volume each, at random";
    real least = 1, most = 0;
    for (std::size_t i = 0; i < volume.part().size(); ++i)
        least = std::min(least, volume.part()[i]), most = std::max(most, volume.part()[i]);
    // Weymouth & Yue's bound: Σ|u| dt/h <= 0.48 < 1/2; 1e-6 is what is not cut, 3e-8 what a cut may be wrong by
    EXPECT_GT(least, -1e-5);
    EXPECT_LT(most, 1 + 1e-5);
}

}  // namespace volume_tests
