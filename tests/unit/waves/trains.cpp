#include "unit/waves/support.hpp"

namespace trains_tests {

using namespace weir;
using namespace weir::waves;
using weir::test::ask;
using weir::test::wave_scene;

namespace {

const std::string two =
    "trains = [ { amplitude = 0.3, wavelength = 12.0, heading = 0.4 }, { amplitude = 0.1, wavelength = 5.0, heading = 1.9, phase = 1.0 } ]";

}  // namespace

TEST("sines: velocities are derivatives in time at the mean level, and free of divergence below") {
    Waves solver(wave_scene(3, "[20, 1, 20]", "[20.0, 10.0, 20.0]", "waves = { model = \"sines\", depth = 3.0, " + two + " }"));
    solver.step(1.3);
    const real h = 1e-4;
    const real now = ask<3>(solver, "velocity", {{3, 0, 7}})[1];
    solver.step(h);
    const real after = ask<1>(solver, "surface", {{3, 0, 7}})[0];
    solver.step(-2 * h);
    const real before = ask<1>(solver, "surface", {{3, 0, 7}})[0];
    solver.step(h);
    EXPECT_NEAR((after - before) / (2 * h), now, 1e-7);
    const auto u = [&](real x, real y, real z, std::size_t a) { return ask<3>(solver, "velocity", {{x, y, z}})[a]; };
    const real div =
        u(3 + h, -1, 7, 0) - u(3 - h, -1, 7, 0) + u(3, -1 + h, 7, 1) - u(3, -1 - h, 7, 1) + u(3, -1, 7 + h, 2) - u(3, -1, 7 - h, 2);
    EXPECT_NEAR(div / (2 * h), 0, 1e-7);
    EXPECT_NEAR(u(3, -3, 7, 1), 0, 1e-15);  // at the floor
}

TEST("trochoids: the height over a point is that of the particle that is there") {
    Waves solver(wave_scene(3, "[40, 1, 40]", "[20.0, 10.0, 20.0]", "waves = { model = \"gerstner\", " + two + " }"));
    solver.step(0.9);
    for (const auto& [x, z] : {std::pair{1.0, 2.0}, {7.7, 3.3}, {15.0, 19.0}}) {
        const Motion m = solver.model().motion(x, z);
        EXPECT_NEAR(ask<1>(solver, "surface", {{x + m.moved[0], 0, z + m.moved[2]}})[0], m.moved[1], 1e-12);
        EXPECT_NEAR(ask<3>(solver, "velocity", {{x + m.moved[0], m.moved[1], z + m.moved[2]}})[0], m.velocity[0], 1e-11);
    }
}

TEST("trochoids: velocity and Jacobian are derivatives, with wind and over a bed too") {
    for (const std::string& more :
         {std::string(), std::string(", lean = 1.0"), std::string(", bed = { x = [0.0, 20.0], depth = [6.0, 3.0] }")}) {
        Waves solver(wave_scene(3, "[40, 1, 40]", "[20.0, 10.0, 20.0]", "waves = { model = \"gerstner\", " + two + more + " }"));
        const Model& model = solver.model();
        solver.step(2.1);
        const Motion now = model.motion(11, 5);
        const real h = 1e-5;
        solver.step(h);
        const Motion after = model.motion(11, 5);
        solver.step(-2 * h);
        const Motion before = model.motion(11, 5);
        solver.step(h);
        for (int a = 0; a < 3; ++a) EXPECT_NEAR((after.moved[a] - before.moved[a]) / (2 * h), now.velocity[a], 1e-8) << more;
        // over the bed amplitudes and axes change too, which the Jacobian leaves out: by the slope, 0.15, of what they are, 0.3 m over some
        // metres
        const real close = more.find("bed") == std::string::npos ? 1e-8 : 0.03;
        EXPECT_NEAR((model.motion(11 + h, 5).moved[0] - model.motion(11 - h, 5).moved[0]) / (2 * h), now.xx, close) << more;
        EXPECT_NEAR((model.motion(11, 5 + h).moved[2] - model.motion(11, 5 - h).moved[2]) / (2 * h), now.zz, close) << more;
        EXPECT_NEAR((model.motion(11, 5 + h).moved[0] - model.motion(11, 5 - h).moved[0]) / (2 * h), now.xz, close) << more;
    }
}

TEST("wind makes the front of a wave steeper than its back, and does not change its height") {
    const auto slopes = [](const std::string& more) {
        Waves solver(wave_scene(2, "[400, 1]", "[12.0, 10.0]",
                                "waves = { model = \"gerstner\", trains = [ { amplitude = 0.5, wavelength = 12.0 } ]" + more + " }"));
        real front = 0, back = 0, top = 0;  // it travels to the right: its front falls there
        for (int i = 0; i < 400; ++i) {
            const real x = 0.03 * i, y = ask<1>(solver, "surface", {{x, 0, 0}})[0],
                       slope = (ask<1>(solver, "surface", {{x + 0.01, 0, 0}})[0] - y) / 0.01;
            front = std::max(front, -slope), back = std::max(back, slope), top = std::max(top, y);
        }
        return std::array<real, 3>{front, back, top};
    };
    const auto still = slopes(""), windy = slopes(", lean = 1.0");
    EXPECT_NEAR(still[0], still[1], 0.01 * still[0]);  // points a hundredth of a metre apart
    EXPECT_GT(windy[0], 1.3 * windy[1]);
    EXPECT_NEAR(windy[2], 0.5, 1e-3);
}

TEST("orbits flatten near the shore, and a wave is no higher than it breaks at") {
    Waves solver(wave_scene(2, "[300, 1]", "[300.0, 10.0]",
                            "waves = { model = \"gerstner\", trains = [ { amplitude = 0.4, wavelength = 30.0 } ], bed = { x = [0.0, "
                            "300.0], depth = [30.0, 0.5] } }"));
    const auto axes = [&](real x) {
        real wide = 0, high = 0;
        for (int turn = 0; turn < 64; ++turn) {
            const Motion m = solver.model().motion(x, 0);
            wide = std::max(wide, std::abs(m.moved[0])), high = std::max(high, std::abs(m.moved[1]));
            solver.step(0.1);
        }
        return std::pair{wide, high};
    };
    const auto [far_wide, far_high] = axes(1.0);
    const auto [near_wide, near_high] = axes(299.5);
    EXPECT_NEAR(far_wide / far_high, 1, 0.01);
    EXPECT_GT(near_wide / near_high, 1.9);     // 1/(1 - e^(-2 k h)) = 2.1 at k h = 0.32, a little less as the ellipse is tilted
    EXPECT_LE(near_high, 0.39 * 0.55 * 1.02);  // McCowan, at the depth there; the tilt adds a little
}

}  // namespace trains_tests
