// Water beside solids that cut its cells: it slides along them without losing or gaining speed, and no transfer feeds on what stands
// inside them.
#include "support.hpp"

using namespace weir;
using namespace weir::test;

namespace {

/// A layer of water on a floor that cuts its cells, all moving along it at 1 m/s, without gravity; x (and z) are periodic.
template <int D>
std::string sliding_layer(const std::string& transfer) {
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {}, periodic = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
solids = [ {{ shape = "box", min = {}, max = {} }} ]
initial = {{ velocity = {{ name = "constant", value = {} }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, list({"12", "16", "8"}, D), list({"0.75", "1.0", "0.5"}, D), D == 2 ? "[\"x\"]" : "[\"x\", \"z\"]",
                       list({"-1.0", "0.195", "-1.0"}, D), list({"2.0", "0.6", "2.0"}, D), list({"-1.0", "-1.0", "-1.0"}, D),
                       list({"2.0", "0.195", "2.0"}, D), list({"1.0", "0.0", "0.0"}, D), transfer);
}

}  // namespace

TEST_IN_2D_AND_3D("a layer that slides over a solid without friction keeps its speed, with every transfer") {
    // Exact for all of them: the velocity is constant, and the continued one inside the solid is the same constant.
    for (const std::string transfer : {"grid", "pic", "flip", "apic"}) {
        mac::Water<D> water(water_scene(sliding_layer<D>(transfer)));
        for (int step = 0; step < 30; ++step) water.step(0.02);
        for (std::size_t p = 0; p < water.markers().count() && transfer != "grid"; ++p) {
            ASSERT_NEAR(water.markers().v[0][p], 1, 1e-9) << transfer << ", marker " << p;
            ASSERT_NEAR(water.markers().v[1][p], 0, 1e-9) << transfer << ", marker " << p;
        }
        EXPECT_NEAR(integral(water, "momentum_x"), 1000 * integral(water, "volume"), 1e-6 * 1000 * integral(water, "volume")) << transfer;
    }
}
