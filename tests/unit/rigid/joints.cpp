// Hinges, sliders and moorings without any fluid: a pendulum's period, what is conserved, what stays in place, what a line carries.
#include "rigid/joints.hpp"

#include "core/checkpoint.hpp"
#include "support.hpp"

namespace joints_tests {

using namespace weir;
using namespace weir::rigid;
using namespace weir::test;

namespace {

std::string at(int dim, real x, real y) { return dim == 2 ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, 2.0]", x, y); }

constexpr real r = 0.2, l = 1.2, g = 9.81;

/// A ball that hangs at an angle below a hinge at (2, 3).
template <int D>
Dry<D> pendulum(real angle) {
    return Dry<D>(fmt::format("bodies = [ {{ name = \"bob\", shape = \"sphere\", centre = {}, radius = {}, density = 10.0 }} ]\n"
                              "joints = [ {{ kind = \"hinge\", body = \"bob\", at = {} }} ]",
                              at(D, 2 + l * std::sin(angle), 3 - l * std::cos(angle)), r, at(D, 2, 3)),
                  g);
}

/// A chain of three boxes, hinged to the world and to each other, and a moored ball.
template <int D>
Dry<D> chain() {
    const auto box = [](real x) {
        return fmt::format("{{ shape = \"box\", min = {}, max = {}, density = 10.0 }}",
                           D == 2 ? fmt::format("[{}, 2.9]", x) : fmt::format("[{}, 2.9, 1.9]", x),
                           D == 2 ? fmt::format("[{}, 3.1]", x + 0.4) : fmt::format("[{}, 3.1, 2.1]", x + 0.4));
    };
    return Dry<D>(
        fmt::format("bodies = [ {}, {}, {}, {{ shape = \"sphere\", centre = {}, radius = 0.1, density = 30.0 }} ]\n"
                    "joints = [ {{ kind = \"hinge\", body = \"0\", at = {} }}, {{ kind = \"hinge\", body = \"1\", to = \"0\", at = {} }},\n"
                    "  {{ kind = \"slider\", body = \"2\", to = \"1\", at = {}, axis = {} }},\n"
                    "  {{ kind = \"mooring\", body = \"3\", to = \"2\", at = {}, anchor = {}, stiffness = 200.0, damping = 1.0 }} ]",
                    box(1.0), box(1.45), box(1.9), at(D, 2.1, 2.4), at(D, 0.975, 3), at(D, 1.425, 3), at(D, 1.875, 3),
                    D == 2 ? "[1.0, 0.1]" : "[1.0, 0.1, 0.0]", at(D, 2.1, 2.4), at(D, 2.1, 3)),
        g);
}

}  // namespace

TEST_IN_2D_AND_3D("a pendulum swings with the period of the textbook") {
    // T = 2 pi sqrt(I/(m g l)) (1 + a²/16 + ...), I about the hinge: a ball or a disc at the distance l.
    const real angle = 0.1, inertia = (D == 2 ? 0.5 : 0.4) * r * r + l * l, dt = 1e-3;
    const real period = 2 * pi * std::sqrt(inertia / (g * l)) * (1 + angle * angle / 16);
    auto world = pendulum<D>(angle);
    std::vector<real> crossings;
    for (real before = angle; crossings.size() < 9;) {
        world.step(dt);
        const real x = world.bodies[0].at[0] - 2;
        if (before > 0 && x <= 0) crossings.push_back(world.time - dt * x / (x - before));
        before = x;
    }
    // Symplectic steps change a period by (omega dt)²/24; the next term of the series is 11 a⁴/3072; a crossing by chords of the path,
    // less.
    const real omega = 2 * pi / period, within = omega * omega * dt * dt / 24 + 11 * std::pow(angle, 4) / 3072;
    EXPECT_NEAR((crossings.back() - crossings.front()) / 8 / period, 1, 2 * within);  // twice: round-off of angles and what chords leave
}

TEST_IN_2D_AND_3D("a hinge holds its point through a fall from the horizontal, and energy comes back") {
    const real dt = 5e-4, fastest = std::sqrt(2 * g * l) * l / l;
    auto world = pendulum<D>(0.5 * pi);
    const real start = world.energy();
    real apart = 0, lowest = infinity, highest_again = -infinity;
    for (int i = 0; i < 8000; ++i) {
        world.step(dt);
        const auto end = world.bodies.joints().ends(world.bodies.joints().all()[0], world.bodies.all());
        apart = std::max(apart, norm(end[0] - end[1]));
        lowest = std::min(lowest, world.bodies[0].at[1]);
        if (i > 4000) highest_again = std::max(highest_again, world.bodies[0].at[1]);
    }
    // In one step the body turns about its centre, which goes straight on: the point leaves its place by v² dt²/(2 l), and is called back.
    EXPECT_LT(apart, fastest * fastest * dt * dt / l);
    EXPECT_NEAR(lowest, 3 - l, fastest * fastest * dt * dt / l + 1e-5);
    // Positions lead velocities by one step: the energy that is read off wanders by g v dt a kilogram, and does not drift.
    EXPECT_NEAR(world.energy(), start, world.bodies[0].mass * g * fastest * dt);
    EXPECT_NEAR(highest_again, 3, fastest * dt);
}

TEST_IN_2D_AND_3D("two bodies on a hinge in free flight keep their momentum and angular momentum") {
    const std::string spin = D == 2 ? "2.0" : "0.5, -0.3, 2.0", corner = D == 2 ? "]" : ", 1.8]", upper = D == 2 ? "]" : ", 2.3]";
    Dry<D> world("bodies = [ { shape = \"box\", min = [1.0, 1.8" + corner + ", max = [1.5, 2.1" + upper + ", density = 5.0, spin = [" +
                     spin + "] }, { shape = \"box\", min = [1.6, 1.9" + corner + ", max = [2.4, 2.2" + upper + ", density = 11.0 } ]\n" +
                     "joints = [ { kind = \"hinge\", body = \"0\", to = \"1\", at = " + at(D, 1.55, 2) + " } ]",
                 0);
    const auto momenta = [&] {
        Vec<D> p{};
        Vec<3> turning{};
        for (const auto& b : world.bodies.all()) {
            Vec<3> x{}, v{};
            for (int a = 0; a < D; ++a) x[a] = b.at[a], v[a] = b.velocity[static_cast<std::size_t>(a)], p[a] += b.mass * v[a];
            turning += b.angular_momentum() + b.mass * cross(x, v);
        }
        return std::pair{p, turning};
    };
    // The first step undoes what the spin has torn apart before anything held it, the second stops that.
    world.step(1e-3), world.step(1e-3);
    const auto before = momenta();
    const real energy = world.energy();
    for (int i = 0; i < 2000; ++i) world.step(1e-3);
    const auto after = momenta();
    // 2000 steps of products of a hundred terms, each to the last bit
    EXPECT_LT(norm(after.first - before.first), 1e-10 * norm(before.second));
    EXPECT_LT(norm(after.second - before.second), 1e-10 * norm(before.second));
    EXPECT_NEAR(world.energy(), energy, 2e-3 * energy);  // of first order: dt omega
}

TEST_IN_2D_AND_3D("a slider keeps its line and its direction, and lets its body fall along it") {
    const real s = 0.6, dt = 1e-3;  // the line's slope; pushed off its centre, so that it would turn
    Dry<D> world(
        fmt::format("bodies = [ {{ shape = \"box\", min = {}, max = {}, density = 10.0 }} ]\njoints = [ {{ kind = \"slider\", body = "
                    "\"0\", at = {}, "
                    "axis = {} }} ]",
                    D == 2 ? "[0.8, 2.8]" : "[0.8, 2.8, 1.5]", D == 2 ? "[1.4, 3.1]" : "[1.4, 3.1, 2.1]", at(D, 0.9, 3.0),
                    D == 2 ? fmt::format("[{}, {}]", std::cos(s), -std::sin(s)) : fmt::format("[{}, {}, 0.0]", std::cos(s), -std::sin(s))),
        g);
    world.bodies.joints().mark(world.bodies.all());  // as solvers do at the start: it does not fall freely
    const Vec<D> from = world.bodies[0].at;
    const int steps = 500;
    for (int i = 0; i < steps; ++i) world.step(dt);
    const Vec<D> way = world.bodies[0].at - from;
    const real along = way[0] * std::cos(s) - way[1] * std::sin(s), off = way[0] * std::sin(s) + way[1] * std::cos(s);
    // Places follow velocities one step late: g sin s dt² n(n − 1)/2. The sweeps end at 1e-10 of the speed, and the next step undoes it.
    EXPECT_NEAR(along, g * std::sin(s) * dt * dt * 0.5 * steps * (steps - 1), 1e-9);
    EXPECT_NEAR(off, 0, 1e-9);
    if (D == 2)
        EXPECT_NEAR(world.bodies[0].orientation[0], 0, 1e-9);
    else
        EXPECT_NEAR(norm(Vec<3>{{world.bodies[0].orientation[1], world.bodies[0].orientation[2], world.bodies[0].orientation[3]}}), 0,
                    1e-9);
}

TEST_IN_2D_AND_3D("a slack line does not damp, however strong its damper: what flies outwards in it goes on exactly as it was") {
    // k s + c v would be a pull of 1000 * 2 - 10 * 0.5 N.
    Dry<D> world(
        fmt::format("bodies = [ {{ shape = \"sphere\", centre = {}, radius = {}, density = 10.0, velocity = {} }} ]\njoints = [ {{ "
                    "kind = \"mooring\", body = \"0\", at = {}, anchor = {}, length = 1.5, stiffness = 10.0, damping = 1000.0 }} ]",
                    at(D, 2, 2), r, D == 2 ? "[2.0, 0.0]" : "[2.0, 0.0, 0.0]", at(D, 2, 2), at(D, 1, 2)),
        0);
    for (int i = 0; i < 20; ++i) world.step(1e-2);  // 0.4 of the 0.5 m that are slack
    EXPECT_NEAR(world.bodies[0].velocity[0], 2.0, 1e-12);
    EXPECT_NEAR(world.bodies[0].at[0], 2.4, 1e-12);
    for (int i = 0; i < 40; ++i) world.step(1e-2);
    EXPECT_LT(world.bodies[0].velocity[0], 0.1);  // taut, it damps
}

TEST("in space a slider turns a body that is out of line by an angle back by its sine: what is left is of the third order") {
    const real angle = 0.2, dt = 1e-2;
    Dry<3> world(
        "bodies = [ { shape = \"box\", min = [1.8, 1.8, 1.8], max = [2.2, 2.2, 2.2], density = 10.0 } ]\njoints = [ { kind = "
        "\"slider\", body = \"0\", at = [2.0, 2.0, 2.0], axis = [1.0, 0.0, 0.0] } ]",
        0);
    const Vec<3> about = (1 / std::sqrt(14.0)) * Vec<3>{{1, 2, 3}};
    auto& turned = world.bodies[0].orientation;
    turned[0] = std::cos(angle / 2);
    for (int a = 0; a < 3; ++a) turned[static_cast<std::size_t>(a + 1)] = std::sin(angle / 2) * about[a];
    world.bodies[0].velocity = {};
    world.step(dt), world.step(dt);  // a velocity that undoes it, and the way
    real left = 0;
    for (std::size_t a = 1; a < 4; ++a) left += turned[a] * turned[a];
    // A cube, so that it turns about one axis: by sin(angle) instead of angle; the second velocity is of what is left then.
    EXPECT_NEAR(2 * std::asin(std::sqrt(left)), angle - std::sin(angle), 1e-3 * angle);
}

TEST_IN_2D_AND_3D("what hangs on a mooring stretches it by its weight over its stiffness; slack, it pulls nothing") {
    const real k = 2000;
    const auto world_of = [&](real length) {
        return Dry<D>(
            fmt::format(
                "bodies = [ {{ shape = \"sphere\", centre = {}, radius = {}, density = 10.0 }} ]\njoints = [ {{ kind = \"mooring\", body = "
                "\"0\", at = {}, anchor = {}, length = {}, stiffness = {}, damping = 40.0 }} ]",
                at(D, 2, 2), r, at(D, 2, 2.2), at(D, 2, 3), length, k),
            g);
    };
    auto hangs = world_of(0.8);
    for (int i = 0; i < 4000; ++i) hangs.step(2e-3);
    const auto& ball = hangs.bodies[0];
    // At rest the spring carries the weight exactly; the sweeps end at 1e-10 of g dt.
    EXPECT_NEAR(2 - ball.at[1], ball.mass * g / k, 1e-8);
    auto falls = world_of(1.5), free = world_of(3.5);
    for (int i = 0; i < 100; ++i) falls.step(2e-3), free.step(2e-3);  // 0.2 m: not yet at its end
    EXPECT_EQ(falls.bodies[0].at, free.bodies[0].at);
    EXPECT_NEAR(falls.bodies[0].at[1], 2 - 0.5 * g * 0.2 * 0.2, 1e-12);  // exactly along the parabola
    for (int i = 0; i < 900; ++i) falls.step(2e-3);
    EXPECT_NEAR(falls.bodies[0].at[0], 2, 1e-9);
    EXPECT_NEAR(falls.bodies[0].at[1], 1.3 - ball.mass * g / k, 1e-2);  // it has bounced and hangs
}

/// A ball between two lines that are stretched by 0.3 m: none goes slack while it swings by less.
template <int D>
Dry<D> sprung(real k, real start) {
    const auto line = [&](real x) {
        return fmt::format("{{ kind = \"mooring\", body = \"0\", at = {}, anchor = {}, length = {}, stiffness = {} }}", at(D, 2 + start, 2),
                           at(D, x, 2), 0.7 + (x < 2 ? start : -start), k);
    };
    return Dry<D>(fmt::format("bodies = [ {{ shape = \"sphere\", centre = {}, radius = {}, density = 10.0 }} ]\njoints = [ {}, {} ]",
                              at(D, 2 + start, 2), r, line(1), line(3)),
                  0);
}

TEST_IN_2D_AND_3D("a swing on lines without damping keeps its width at a hundredth of its period, and its period") {
    const real k = 500, omega = std::sqrt(2 * k / sprung<D>(k, 0).bodies[0].mass), period = 2 * pi / omega, dt = period / 100, start = 0.1;
    auto world = sprung<D>(k, 0);
    world.bodies[0].velocity[0] = omega * start;
    std::vector<real> widest(20);  // of each swing
    for (real& width : widest)
        for (int i = 0; i < 100; ++i) {
            world.step(dt);
            width = std::max(width, std::abs(world.bodies[0].at[0] - 2));
        }
    // The scheme keeps a quadratic form of x and v: nothing is lost but to the onset of damping for steps that do not resolve it, which
    // takes (z/2)⁴/4 z² = 4e-10 of the energy a step. A maximum over steps misses at most (π/100)²/2 = 5e-4 of the width.
    EXPECT_NEAR(widest.front(), start, 1e-3 * start);
    EXPECT_NEAR(widest.back(), widest.front(), 1e-3 * start);
}

TEST_IN_2D_AND_3D("stiff lines neither ring nor throw what they hold, at steps of many of their periods") {
    for (const real z : {3.0, 30.0}) {
        const real dt = 1e-2, k = 0.5 * sprung<D>(1, 0).bodies[0].mass * z * z / (dt * dt);
        auto world = sprung<D>(k, 0);
        world.bodies[0].velocity[0] = 1;
        real late = 0;
        for (int i = 0; i < 400; ++i) {
            world.step(dt);
            // What is let go at 1 m/s comes as far as one step before the lines have seen it.
            EXPECT_LT(std::abs(world.bodies[0].at[0] - 2), 1.01 * dt) << z << ' ' << i;
            if (i > 300) late = std::max(late, std::abs(world.bodies[0].velocity[0]));
        }
        EXPECT_LT(late, 1e-3) << z;  // at z = 3 a step leaves (1 + c z²)/(1 + b z²) = 0.26 of the square of the swing
    }
    for (const real z : {3.0, 3000.0}) {  // one line, and a weight that is let go
        const real dt = 1e-2, mass = sprung<D>(1, 0).bodies[0].mass, k = mass * z * z / (dt * dt);
        Dry<D> world(fmt::format("bodies = [ {{ shape = \"sphere\", centre = {}, radius = {}, density = 10.0 }} ]\njoints = [ {{ kind = "
                                 "\"mooring\", body = \"0\", at = {}, anchor = {}, stiffness = {} }} ]",
                                 at(D, 2, 2), r, at(D, 2, 2.2), at(D, 2, 3), k),
                     g);
        for (int i = 0; i < 400; ++i) {
            world.step(dt);
            EXPECT_LT(2 - world.bodies[0].at[1], mass * g / k + 1.01 * g * dt * dt) << z << ' ' << i;
        }
        EXPECT_NEAR(2 - world.bodies[0].at[1], mass * g / k, 1e-6) << z;  // it hangs
    }
}

TEST_IN_2D_AND_3D("a chain of joints goes on from a checkpoint bit for bit") {
    auto whole = chain<D>(), first = chain<D>(), second = chain<D>();
    for (int i = 0; i < 200; ++i) whole.step(1e-3);
    for (int i = 0; i < 100; ++i) first.step(1e-3);
    Checkpoint state;
    first.bodies.save(state);
    second.bodies.restore(state);
    for (int i = 0; i < 100; ++i) second.step(1e-3);
    for (std::size_t b = 0; b < whole.bodies.count(); ++b) {
        EXPECT_EQ(second.bodies[b].at, whole.bodies[b].at) << b;
        EXPECT_EQ(second.bodies[b].orientation, whole.bodies[b].orientation) << b;
        EXPECT_EQ(second.bodies[b].velocity, whole.bodies[b].velocity) << b;
    }
    EXPECT_GT(norm(whole.bodies[1].at - chain<D>().bodies[1].at), 0.01);  // it has moved
}

}  // namespace joints_tests
