// A tank that rolls, full of liquid: vorticity in the laboratory is kept, so that seen from the tank it is −2 (Ω(t) − Ω(0)) everywhere.
#include "mac/grid/effects.hpp"
#include "support.hpp"
#include "support/inner_vorticity.hpp"

namespace weir::test::rolling_tests {
namespace {

using water::Water;

/// A closed box of liquid that rolls about an axis beside its middle.
template <int D>
scene::Scene full_tank(const std::string& axis, const std::string& transfer) {
    return water_scene(fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
effects.gravity.g = {}
effects.rotating_frame = {{ centre = {}, axis = "{}", amplitude = 0.3, period = 1.3 }}
scheme = {{ transfer = "{}" }}
)",
                                   D, list({"16", "12", "10"}, D), list({"0.8", "0.6", "0.5"}, D), list({"-1.0", "-1.0", "-1.0"}, D),
                                   list({"2.0", "2.0", "2.0"}, D), list({"0.0", "-9.81", "0.0"}, D), list({"0.1", "0.2", "0.9"}, D), axis,
                                   transfer));
}

/// The effect alone, with its axis along `axis`.
template <int D>
std::unique_ptr<mac::MacEffect<D>> effect_of(const scene::Scene& scene) {
    const auto kind = mac::rotating_frame();
    if constexpr (D == 2)
        return kind.make_2d(*scene.effect("rotating_frame"), scene);
    else
        return kind.make_3d(*scene.effect("rotating_frame"), scene);
}

}  // namespace

/// In the full tank the Coriolis force is a pressure: it is seen here.
TEST_IN_2D_AND_3D("a uniform velocity turns by 2 Omega dt against the rotation, between halves of the other forces") {
    for (const std::string& axis : D == 2 ? std::vector<std::string>{"z"} : std::vector<std::string>{"x", "y", "z"}) {
        const auto scene = full_tank<D>(axis, "grid");
        const geometry::RotatingFrame<D> frame(*scene.effect("rotating_frame"), scene);
        mac::MacState<D> state(scene, {});
        const real dt = 0.02;
        const auto roll = frame.at(dt);
        Vec<D> before{};
        for (int a = 0; a < D; ++a) {
            before[a] = 3 - 2 * a;
            state.u[a].fill(before[a]);
        }
        effect_of<D>(scene)->apply(state, dt);
        const int p = frame.p(), q = frame.q();
        const real c = std::cos(2 * roll.rate * dt), s = std::sin(2 * roll.rate * dt);
        for (const int a : {p, q}) {
            Index<D> I;
            for (int d = 0; d < D; ++d) I[d] = state.u.cells[d] / 2;
            const Vec<D> x = state.u.face_centre(a, I), f = frame.acceleration(roll, x);
            const Vec<D> half = before + (dt / 2) * (f - frame.gravity());
            const real turned = a == p ? c * half[p] + s * half[q] : c * half[q] - s * half[p];
            const real angle = 2 * std::abs(roll.rate) * dt;
            // the split turn is exact to the third power of the angle; the four faces around stand at the same place in the mean
            EXPECT_NEAR(state.u[a](I), turned + dt / 2 * (f[a] + frame.gravity()[a]), 4 * angle * angle * angle)
                << axis << ", component " << a;
        }
    }
}

TEST_IN_2D_AND_3D("liquid that fills a tank does not take part in a change of its rotation") {
    for (const char* transfer : {"grid", "flip", "apic"})
        for (const std::string& axis : D == 2 ? std::vector<std::string>{"z"} : std::vector<std::string>{"x", "y", "z"}) {
            const auto scene = full_tank<D>(axis, transfer);
            const geometry::RotatingFrame<D> frame(*scene.effect("rotating_frame"), scene);
            Water<D> water(scene);
            const real dt = 1.3 / 4 / 65;
            for (int step = 0; step < 65; ++step) water.step(dt);
            const real change = frame.at(water.time()).rate - frame.at(0).rate;
            ASSERT_LT(change, -1.4) << axis;  // 2 pi 0.3 / 1.3, after a quarter period
            EXPECT_NEAR(inner_vorticity(water.state().u, frame), -2 * change, -0.1 * change)
                << axis << ", " << transfer;  // 1% of time, diffusion
        }
}

}  // namespace weir::test::rolling_tests
