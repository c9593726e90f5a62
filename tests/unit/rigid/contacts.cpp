// Bodies against walls, solids and each other, without any fluid: bounces, rest, friction, momentum.
#include "support.hpp"

namespace contacts_tests {

using namespace weir;
using namespace weir::rigid;
using namespace weir::test;

TEST_IN_2D_AND_3D("a ball dropped from h bounces to h e²") {
    for (const real e : {0.5, 0.9}) {
        Dry<D> world(fmt::format("bodies = [ {{ shape = \"sphere\", centre = {}, radius = 0.25, density = 100.0, restitution = {} }} ]",
                                 D == 2 ? "[2.0, 1.25]" : "[2.0, 1.25, 2.0]", e));
        const real h = 1.0, dt = 2e-4;
        real highest = 0;
        bool bounced = false;
        for (int i = 0; i < 10000 && !(bounced && world.bodies[0].velocity[1] < 0); ++i) {
            world.step(dt);
            bounced = bounced || world.bodies[0].velocity[1] > 0;
            if (bounced) highest = std::max(highest, world.bodies[0].at[1] - 0.25);
        }
        // The bounce happens within one step of the touch: at most v dt above the wall, where a ball has less than its full speed. And the
        // top lies at most one step's rise from the highest step.
        const real within = std::sqrt(2 * 9.81 * h) * dt * (1 + e * e);
        EXPECT_NEAR(highest, e * e * h, within);
    }
}

TEST_IN_2D_AND_3D("bodies of mass ratio 1000 stacked on the floor come to rest and stay where they are") {
    const auto box = [](real low, real high, real density) {
        return fmt::format("{{ shape = \"box\", min = {}, max = {}, density = {}, friction = 0.5 }}",
                           D == 2 ? fmt::format("[1.5, {}]", low) : fmt::format("[1.5, {}, 1.5]", low),
                           D == 2 ? fmt::format("[2.5, {}]", high) : fmt::format("[2.5, {}, 2.5]", high), density);
    };
    Dry<D> world("bodies = [ " + box(0.0, 0.5, 1.0) + ", " + box(0.5, 1.0, 1000.0) + ", " + box(1.0, 1.5, 1.0) + " ]");
    for (int i = 0; i < 400; ++i) world.step(0.005);
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_NEAR(world.bodies[b].at[1], 0.25 + 0.5 * static_cast<real>(b), 2e-3) << b;  // the slop of each contact: 1e-3 of the radius
        EXPECT_NEAR(world.bodies[b].at[0], 2.0, 2e-3) << b;
    }
}

TEST("a box on a slope slides where the slope is steeper than friction holds, and at the rate of the textbook") {
    // On a slope of angle s: at rest if tan s < μ, else g (sin s − μ cos s). The slope is gravity's: the floor is flat.
    for (const real mu : {0.2, 0.6}) {
        Dry<2> world(
            fmt::format("bodies = [ {{ shape = \"box\", min = [0.5, 0.0], max = [0.9, 0.2], density = 10.0, friction = {} }} ]", mu));
        const real s = 0.4, dt = 1e-3;
        world.gravity = {{9.81 * std::sin(s), -9.81 * std::cos(s)}};
        for (int i = 0; i < 500; ++i) world.step(dt);
        const real expected = mu > std::tan(s) ? 0 : 9.81 * (std::sin(s) - mu * std::cos(s)) * 0.5;
        EXPECT_NEAR(world.bodies[0].velocity[0], expected, 9.81 * dt) << mu;  // one step's push
    }
}

TEST("two bodies rub with the geometric mean of their frictions: a box on a fixed slab slides at the rate of the textbook") {
    for (const bool box_is_rough : {false, true}) {  // sqrt(0.9 * 0.1) = 0.3; the arithmetic mean would be 0.5
        Dry<2> world(
            fmt::format("bodies = [ {{ shape = \"box\", min = [0.2, 1.0], max = [3.8, 1.2], density = 10.0, friction = {}, fixed = "
                        "[\"x\", \"y\", \"turning\"] }}, {{ shape = \"box\", min = [0.5, 1.2], max = [0.9, 1.4], density = 10.0, "
                        "friction = {} }} ]",
                        box_is_rough ? 0.1 : 0.9, box_is_rough ? 0.9 : 0.1));
        const real s = 0.6, dt = 1e-3;  // tan s = 0.68
        world.gravity = {{9.81 * std::sin(s), -9.81 * std::cos(s)}};
        for (int i = 0; i < 500; ++i) world.step(dt);
        EXPECT_NEAR(world.bodies[1].velocity[0], 9.81 * (std::sin(s) - 0.3 * std::cos(s)) * 0.5, 9.81 * dt);  // one step's push
    }
}

TEST_IN_2D_AND_3D("two bodies that collide keep their momentum, and their energy where restitution is one") {
    const std::string at = D == 2 ? "[1.0, 2.0]" : "[1.0, 2.0, 2.0]", to = D == 2 ? "[2.0, 2.1]" : "[2.0, 2.1, 2.0]";
    const std::string v = D == 2 ? "[2.0, 0.0]" : "[2.0, 0.0, 0.0]";
    Dry<D> world("bodies = [ { shape = \"sphere\", centre = " + at + ", radius = 0.3, density = 10.0, restitution = 1.0, velocity = " + v +
                     " }, { shape = \"sphere\", centre = " + to + ", radius = 0.3, density = 40.0 } ]",
                 0);
    const auto momentum = [&] {
        Vec<D> p{};
        for (const auto& b : world.bodies.all())
            for (int a = 0; a < D; ++a) p[a] += b.mass * b.velocity[static_cast<std::size_t>(a)];
        return p;
    };
    const Vec<D> before = momentum();
    const real energy = world.energy();
    for (int i = 0; i < 300; ++i) world.step(0.001);
    EXPECT_LT(world.bodies[0].velocity[0], 0);  // it has bounced back from the heavier one
    EXPECT_LT(norm(momentum() - before), 1e-13 * norm(before));
    EXPECT_NEAR(world.energy(), energy, 1e-9 * energy);  // the sweeps end at 1e-10 of the speed
}

TEST("a body comes to rest on a solid of the scene, and is carried by one that moves") {
    Dry<2> world(
        "solids = [ { shape = \"box\", min = [0.0, 0.0], max = [4.0, 1.0], motion = { kind = \"constant\", velocity = [0.3, 0.0] } } ]\n"
        "bodies = [ { shape = \"box\", min = [1.0, 1.05], max = [1.4, 1.25], density = 10.0, friction = 1.0 } ]");
    for (int i = 0; i < 600; ++i) {
        world.solids.set_time(world.time);
        world.step(0.002);
    }
    EXPECT_NEAR(world.bodies[0].at[1], 1.1, 2e-3);
    EXPECT_NEAR(world.bodies[0].velocity[0], 0.3, 1e-6);
}

TEST_IN_2D_AND_3D("a ball turns back at every wall where its surface meets it") {
    const real dt = 1e-3;
    for (int a = 0; a < D; ++a)
        for (const real way : {-1.0, 1.0}) {
            Dry<D> world(
                fmt::format("bodies = [ {{ shape = \"sphere\", centre = {}, radius = 0.25, density = 100.0, restitution = 1.0 }} ]",
                            D == 2 ? "[2.0, 2.0]" : "[2.0, 2.0, 2.0]"),
                0);
            world.bodies[0].velocity[static_cast<std::size_t>(a)] = 2 * way;
            real furthest = 0;
            for (int i = 0; i < 1500; ++i) world.step(dt), furthest = std::max(furthest, way * (world.bodies[0].at[a] - 2));
            EXPECT_NEAR(furthest, 1.75, 2 * dt) << a << ' ' << way;  // a step's way
            EXPECT_NEAR(world.bodies[0].velocity[static_cast<std::size_t>(a)], -2 * way, 1e-9);
        }
}

TEST_IN_2D_AND_3D("what lies on the floor does not bounce, however lively") {
    Dry<D> world(fmt::format("bodies = [ {{ shape = \"sphere\", centre = {}, radius = 0.25, density = 100.0, restitution = 0.9 }} ]",
                             D == 2 ? "[2.0, 0.25]" : "[2.0, 0.25, 2.0]"));
    real fastest = 0;
    for (int i = 0; i < 200; ++i) world.step(2e-3), fastest = std::max(fastest, std::abs(world.bodies[0].velocity[1]));
    EXPECT_LT(fastest, 1e-9);  // a bounce by the fall of a step would be 0.9 g dt, 1.8e-2 m/s
}

}  // namespace contacts_tests
