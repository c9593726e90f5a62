// The frame of a tank that rolls: a particle on which nothing but gravity acts moves on the parabola of the laboratory, seen from the tank.
#include "geometry/rotating_frame.hpp"
#include "unit/pbf/scenes.hpp"

#include "support/test.hpp"

#include <cmath>

namespace rotating_frame_tests {

using namespace weir;
using particles::Fluid;

namespace {

/// About an axis beside the middle: a constant rate, and a roll whose amplitude grows.
template <int D>
scene::Scene rolling(const std::string& axis) {
    return test::pbf_scene<D>(
        test::box<D>(0.125, 0.125, 0.125), "",
        fmt::format(
            "effects.rotating_frame = {{ centre = {}, axis = \"{}\", rate = 0.7, amplitude = 0.4, period = 0.9, phase = 0.3, ramp = 0.5 }}",
            D == 2 ? "[0.3, 0.6]" : "[0.3, 0.6, 0.7]", axis));
}

template <int D>
geometry::RotatingFrame<D> frame_of(const scene::Scene& scene) {
    return {*scene.effect("rotating_frame"), scene};
}

/// x of the laboratory as the turned coordinates show it.
template <int D>
Vec<D> turned(const geometry::RotatingFrame<D>& frame, const Vec<D>& centre, real angle, const Vec<D>& x) {
    Vec<D> r = x - centre;
    const real rp = r[frame.p()], rq = r[frame.q()];
    r[frame.p()] = std::cos(angle) * rp + std::sin(angle) * rq;
    r[frame.q()] = std::cos(angle) * rq - std::sin(angle) * rp;
    return centre + r;
}

std::vector<std::string> axes(int dim) { return dim == 2 ? std::vector<std::string>{"z"} : std::vector<std::string>{"x", "y", "z"}; }

/// Distance of the particle after 0.2 s from where the laboratory's parabola leads.
template <int D>
real distance_from_parabola(const scene::Scene& scene, real dt) {
    const auto frame = frame_of<D>(scene);
    const Vec<D> centre = scene.effect("rotating_frame")->template vec<D>("centre"), g = scene.effect("gravity")->template vec<D>("g");
    const Vec<D> begin = Vec<D>::constant(0.6);
    Vec<D> velocity{};
    velocity[0] = 0.3, velocity[1] = 0.9;
    const auto seen = [&](real t) { return turned(frame, centre, frame.at(t).angle, begin + t * velocity + (t * t / 2) * g); };
    auto solver = test::pbf_solver<D>(scene);
    Fluid<D>::put(solver->fluid().x, 0, seen(0));
    Fluid<D>::put(solver->fluid().v, 0,
                  (seen(0.5e-6 - dt / 2) - seen(-0.5e-6 - dt / 2)) / 1e-6);  // in the middle of steps, as the scheme has it
    const int steps = static_cast<int>(std::lround(0.2 / dt));
    for (int s = 0; s < steps; ++s) solver->step(dt);
    return norm(solver->fluid().position(0) - seen(0.2));
}

}  // namespace

TEST_IN_2D_AND_3D("a particle in a tank that rolls follows the parabola of the laboratory, to second order of the step") {
    for (const auto& axis : axes(D)) {
        const auto scene = rolling<D>(axis);
        const real coarse = distance_from_parabola<D>(scene, 0.01), fine = distance_from_parabola<D>(scene, 0.005);
        EXPECT_LT(coarse, 2e-3) << axis;  // 2 Omega dt of the speed of 1 m/s, over 0.2 s, to second order
        EXPECT_GT(coarse / fine, 3) << axis << ": " << coarse << " and " << fine;  // 4 in the limit
    }
}

TEST_IN_2D_AND_3D("rate and acceleration of a roll are the derivatives of its angle, also while its amplitude grows") {
    const auto frame = frame_of<D>(rolling<D>("z"));
    const real eps = 1e-5;
    for (const real t : {0.05, 0.1, 0.49, 0.51, 2.0}) {
        const auto before = frame.at(t - eps), here = frame.at(t), after = frame.at(t + eps);
        EXPECT_NEAR(here.rate, (after.angle - before.angle) / (2 * eps), 1e-6) << t;  // eps^2 times a third derivative of some 1e3
        EXPECT_NEAR(here.acceleration, (after.rate - before.rate) / (2 * eps), 1e-5) << t;
    }
}

TEST_IN_2D_AND_3D("the limit of the acceleration holds at any time, in any corner") {
    for (const auto& axis : axes(D)) {
        const auto scene = rolling<D>(axis);
        const auto frame = frame_of<D>(scene);
        const Vec<D> lo = Vec<D>::constant(-0.2), hi = Vec<D>::constant(1.4), g = scene.effect("gravity")->template vec<D>("g");
        const real most = frame.most(lo, hi);
        real largest = 0;
        for (real t = 0; t < 3; t += 0.01)
            for (int corner = 0; corner < 1 << D; ++corner) {
                Vec<D> x;
                for (int a = 0; a < D; ++a) x[a] = corner >> a & 1 ? hi[a] : lo[a];
                largest = std::max(largest, norm(frame.acceleration(frame.at(t), x) + g));
            }
        EXPECT_LE(largest, most) << axis;
        EXPECT_GT(largest, most / 4) << axis;  // of use
    }
}

TEST("what would not turn with the tank is refused, with its place, what was found and what is allowed") {
    const std::string rolls = "effects.rotating_frame = { centre = [0.5, 0.5], amplitude = 0.1";
    const auto refusal = [](const std::string& more) -> std::string {
        try {
            frame_of<2>(test::pbf_scene<2>(test::box<2>(0.125, 0.125, 0.125), "", more));
        } catch (const BadInput& e) {
            return e.what();
        }
        return "accepted";
    };
    EXPECT_EQ(refusal(rolls + " }"), "accepted");
    struct Case {
        std::string more, says;
    };
    for (const Case& c : {
             Case{rolls + ", axis = \"x\" }", "test.toml:10:73: effects.rotating_frame.axis is \"x\"; with dim = 2 it must be \"z\"\n"},
             Case{rolls + " }\nsides = { y_max = { kind = \"open\" } }",
                  "test.toml:11:28: sides.y_max is \"outflow\"; in a rotating frame the sides around the axis must be \"wall\"\n"},
             Case{rolls + " }\nsides = { x_min = { kind = \"periodic\" }, x_max = { kind = \"periodic\" } }",
                  "test.toml:11:28: sides.x_min is \"periodic\"; in a rotating frame the sides around the axis must be \"wall\"\n"},
             Case{rolls + " }\nemitters = [{ shape = \"box\", min = [0.2, 0.9], max = [0.4, 1.0], velocity = [0, -1] }]",
                  "test.toml:11:12: emitters are not supported in a rotating frame"},
         })
        EXPECT_TRUE(refusal(c.more).starts_with(c.says)) << refusal(c.more);
}

TEST("a constant rotation is no idle effect; a frame that does not turn is one") {
    const auto idle = [](const std::string& keys) {
        const auto scene = test::pbf_scene<2>(test::box<2>(0.125, 0.125, 0.125), "",
                                              fmt::format("effects.rotating_frame = {{ centre = [0.5, 0.5]{} }}", keys));
        return scene::idle_effects(scene, pbf::kind().schema);
    };
    EXPECT_EQ(idle(""), std::vector<std::string>{"rotating_frame"});
    EXPECT_EQ(idle(", phase = 0.5"), std::vector<std::string>{"rotating_frame"});
    EXPECT_EQ(idle(", rate = 1.0"), std::vector<std::string>{});
    EXPECT_EQ(idle(", amplitude = 0.1"), std::vector<std::string>{});
}

}  // namespace rotating_frame_tests
