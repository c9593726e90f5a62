// A tank that rolls: vorticity in the laboratory is kept, so that seen from the tank it is −2 (Ω(t) − Ω(0)) everywhere.
#include "support.hpp"
#include "support/inner_vorticity.hpp"

namespace rolling_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

/// A closed box that rolls about an axis beside its middle, with two fluids of one density, one above the other.
template <int D>
scene::Scene full_tank(const std::string& axis) {
    return two_phase_scene(fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
gas = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
effects.gravity.g = {}
effects.rotating_frame = {{ centre = {}, axis = "{}", amplitude = 0.3, period = 1.3 }}
)",
                                       D, list({"16", "12", "10"}, D), list({"0.8", "0.6", "0.5"}, D), list({"-1.0", "-1.0", "-1.0"}, D),
                                       list({"2.0", "0.31", "2.0"}, D), list({"0.0", "-9.81", "0.0"}, D), list({"0.1", "0.2", "0.9"}, D),
                                       axis));
}

}  // namespace

// As tests/unit/water/rolling.cpp: 1% of time, 65 steps of a quarter period; the rest is diffusion of the transport.
TEST_IN_2D_AND_3D("two fluids of one density that fill a tank do not take part in a change of its rotation") {
    for (const std::string& axis : D == 2 ? std::vector<std::string>{"z"} : std::vector<std::string>{"x", "y", "z"}) {
        const auto scene = full_tank<D>(axis);
        const geometry::RotatingFrame<D> frame(*scene.effect("rotating_frame"), scene);
        TwoPhase<D> solver(scene);
        const real dt = 1.3 / 4 / 65;
        for (int step = 0; step < 65; ++step) solver.step(dt);
        const real change = frame.at(solver.time()).rate - frame.at(0).rate;
        ASSERT_LT(change, -1.4) << axis;  // 2 pi 0.3 / 1.3, after a quarter period
        EXPECT_NEAR(inner_vorticity(solver.state().u, frame), -2 * change, -0.1 * change) << axis;
    }
}

}  // namespace rolling_tests
