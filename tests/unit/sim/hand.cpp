// The hand: what it gives is what the fluid has got, it touches nothing beyond its brush, no target is faster than a cell a step, and what
// it pours and drains is counted.
#include "core/hand.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fmt/core.h>

#include <fstream>
#include <iterator>

namespace {

using namespace weir;

template <int D>
std::string list(real x, real y, real z) {
    return D == 2 ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, {}]", x, y, z);
}
constexpr int cells(int dim) { return dim == 2 ? 24 : 12; }

/// A unit box without gravity in steps of dt; particles and water: a ball of liquid in its middle.
template <int D>
std::string box(const std::string& solver, real dt, const std::string& more, int n = cells(D), const std::string& in_time = "",
                const std::string& in_grid = "") {
    return fmt::format(
        "solver = \"{}\"\ndim = {}\ngrid = {{ cells = {}, size = {}{} }}\ntime = {{ end = 1.0, dt = {}{} }}\nfluid.density = 1000\n{}{}\n",
        solver, D, list<D>(n, n, n), list<D>(1, 1, 1), in_grid, dt, in_time,
        solver == "mac" ? "" : "liquid = [ { shape = \"sphere\", centre = " + list<D>(0.5, 0.5, 0.5) + ", radius = 0.3 } ]\n", more);
}
std::string keyframe(real time, const std::string& kind, const std::string& centre, real radius, const std::string& more) {
    return fmt::format("{{ time = {}, kind = \"{}\", centre = {}, radius = {}, {} }}", time, kind, centre, radius, more);
}
std::string hand(const std::string& frames) { return "effects.hand = { rate = 40, keyframes = [ " + frames + " ] }\n"; }

Simulation start(const std::string& text) { return Simulation(scene::parse(text, "hand.toml", sim::schemas())); }
real integral(const Simulation& simulation, const std::string& name) {
    for (const auto& i : simulation.solver().integrals())
        if (i.name == name) return i.value;
    throw std::logic_error("no integral " + name);
}
template <int D>
Vec<D> vector(const Simulation& simulation, const std::string& name) {
    Vec<D> v;
    for (int a = 0; a < D; ++a) v[a] = integral(simulation, name + "_" + "xyz"[a]);
    return v;
}
std::string state_of(const Simulation& simulation) {
    Checkpoint state;
    simulation.solver().save(state);
    test::TemporaryFolder folder;
    state.write(folder.path() / "a");
    std::ifstream file(folder.path() / "a", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

const std::string periodic_2d = ", periodic = [\"x\", \"y\"]", periodic_3d = ", periodic = [\"x\", \"y\", \"z\"]";

TEST_IN_2D_AND_3D("in a periodic box with fluxes the momentum of the fluid is what the hand gave, push and pull, after many steps") {
    const std::string frames = keyframe(0, "push", list<D>(0.4, 0.5, 0.5), 0.3, "velocity = " + list<D>(1, 0.5, -0.25)) + ", " +
                               keyframe(0.03, "pull", list<D>(0.6, 0.5, 0.5), 0.25, "speed = 1.0");
    auto simulation =
        start(box<D>("mac", 0.005, "scheme = { advection = \"conservative\", poisson = { tolerance = 1e-12 } }\n" + hand(frames), cells(D),
                     "", D == 2 ? periodic_2d : periodic_3d));
    for (int s = 0; s < 12; ++s) simulation.step();
    const Vec<D> given = vector<D>(simulation, "hand_impulse"), has = vector<D>(simulation, "momentum");
    EXPECT_GT(norm(given), 1);
    // Fluxes and pressure take from one face what they give to the next: what is left is rounding, of every face in every substep, of
    // values up to the largest speed: n faces x 3 substeps x 12 steps x a dozen operations x epsilon, of the momentum of all fluid at 1
    // m/s.
    EXPECT_LT(norm(has - given), std::pow(cells(D), D) * 36 * 12 * 2.2e-16 * 1000);
}

TEST_IN_2D_AND_3D("a ball of particles has the momentum that the hand gave it, to the single precision of its pairs") {
    for (const char* solver : {"pbf", "sph"}) {
        const real dt = solver == std::string("pbf") ? 0.005 : 0.0005;
        const std::string frames = keyframe(0, "push", list<D>(0.4, 0.5, 0.5), 0.2, "velocity = " + list<D>(1, 0.5, -0.25)) + ", " +
                                   keyframe(5 * dt, "pull", list<D>(0.6, 0.5, 0.5), 0.15, "speed = 0.5");
        auto simulation = start(box<D>(solver, dt, hand(frames)));
        const real mass = integral(simulation, "mass");
        const Vec<D> before = vector<D>(simulation, "momentum");
        for (int s = 0; s < 10; ++s) simulation.step();
        const Vec<D> given = vector<D>(simulation, "hand_impulse"), got = vector<D>(simulation, "momentum") - before;
        // Single precision, 6e-8, over at most 60 pairs in each of 10 steps: of PBF's moves, of a spacing's size, in each of 5 iterations,
        // which become velocities over dt; of SPH's accelerations by pressure, at most c^2 over a spacing with c = 10 m/s, over dt.
        const real of_a_pass = 10 * 60 * 6e-8 / cells(D) / dt;
        const real rounding = mass * (solver == std::string("pbf") ? 5 * of_a_pass : of_a_pass * std::pow(10 * dt * cells(D), 2));
        EXPECT_GT(norm(given), 5 * rounding) << solver;
        EXPECT_LT(norm(got - given), rounding) << solver;
    }
}

TEST_IN_2D_AND_3D("a floating ball of water has it to half the layer of cells in which its surface lies") {
    const std::string frames = keyframe(0, "push", list<D>(0.5, 0.5, 0.5), 1, "velocity = " + list<D>(0.5, 0, 0));
    auto simulation = start(box<D>("mac_water", 0.005, hand(frames), 24));
    for (int s = 0; s < 8; ++s) simulation.step();
    const Vec<D> given = vector<D>(simulation, "hand_impulse"), has = vector<D>(simulation, "momentum");
    // A face is of the liquid or not, by its two cells: the surface is known to half a cell all around, and is not faster than the hand.
    const real half_layer = (D == 2 ? 2 * pi * 0.3 : 4 * pi * 0.3 * 0.3) * 0.5 / 24;
    EXPECT_GT(norm(given), 2 * 1000 * half_layer * 0.5);
    EXPECT_LT(norm(has - given), 1000 * half_layer * 0.5);
}

TEST_IN_2D_AND_3D("a hand that covers no fluid, or is off, changes no bit") {
    for (const char* solver : {"mac_water", "pbf", "sph"}) {
        auto off = start(box<D>(solver, 0.002, hand("{ time = 0.0, kind = \"off\" }")));
        auto away =
            start(box<D>(solver, 0.002, hand(keyframe(0, "push", list<D>(0.08, 0.08, 0.08), 0.08, "velocity = " + list<D>(1, 1, 1)))));
        for (int s = 0; s < 3; ++s) off.step(), away.step();
        EXPECT_EQ(state_of(off), state_of(away)) << solver;
        EXPECT_EQ(integral(away, "hand_mass"), 0);
    }
}

TEST_IN_2D_AND_3D("beyond the brush no particle is touched in the step in which it pushes") {
    const auto frames = [](const char* kind) {
        return hand(keyframe(0, kind, list<D>(0.5, 0.5, 0.5), 0.15, "velocity = " + list<D>(1, 0, 0)));
    };
    auto off = start(box<D>("sph", 0.0005, frames("off"))), pushed = start(box<D>("sph", 0.0005, frames("push")));
    off.step(), pushed.step();
    const FieldSet a = off.fields(), b = pushed.fields();
    const auto *x = a.find("particles", "position"), *u = a.find("particles", "velocity"), *v = b.find("particles", "velocity");
    int inside = 0;
    for (std::size_t i = 0; i < x->data[0].size(); ++i) {
        Vec<D> at;
        bool same = true;
        for (int c = 0; c < D; ++c) {
            const auto n = static_cast<std::size_t>(c);
            at[c] = x->data[n][i] - 0.5;
            same = same && u->data[n][i] == v->data[n][i];
        }
        const bool covered = norm(at) < 0.15 - 1e-3;  // it has moved by less than that
        EXPECT_TRUE(same || norm(at) < 0.15) << norm(at);
        inside += covered && !same;
    }
    EXPECT_GT(inside, 3);
}

TEST("a target is cut to a cell, or a spacing, a step") {
    const real dt = 0.01, h = 1.0 / cells(2);
    for (const char* solver : {"mac", "mac_water", "pbf", "sph"}) {
        auto simulation =
            start(box<2>(solver, dt, hand(keyframe(0, "push", "[0.5, 0.5]", 0.2, "velocity = [1e6, 0]")), cells(2), ", guard = \"off\""));
        simulation.step();
        EXPECT_LE(integral(simulation, std::string(solver) == "mac_water" ? "momentum_x" : "max_speed") /
                      (std::string(solver) == "mac_water" ? 1000 * pi * 0.3 * 0.3 : 1),
                  1.01 * h / dt)
            << solver;  // the pressure may turn it aside, not speed it up
        EXPECT_GT(integral(simulation, "hand_impulse_x"), 0) << solver;
    }
}

TEST_IN_2D_AND_3D("what is poured is there, a drain takes it out, and the ledger has both") {
    for (const char* solver : {"mac_water", "pbf", "sph"}) {
        const real dt = 0.002;
        const std::string frames = keyframe(0, "pour", list<D>(0.2, 0.8, 0.5), 0.15, "velocity = " + list<D>(0, -0.5, 0)) + ", " +
                                   keyframe(0.02, "drain", list<D>(0.5, 0.5, 0.5), 0.1, "speed = 0.0");
        auto simulation = start(box<D>(solver, dt, hand(frames)));
        const std::string volume = std::string(solver) == "mac_water" ? "volume_target" : "volume";
        const real before = integral(simulation, volume);
        while (simulation.time() < 0.019) simulation.step();
        const real poured = integral(simulation, "hand_mass") / 1000;
        const real ball = D == 2 ? pi * 0.15 * 0.15 : 4 * pi / 3 * std::pow(0.15, 3);
        EXPECT_GT(poured, 0.5 * ball) << solver;
        EXPECT_LT(poured, 2 * ball) << solver;
        EXPECT_NEAR(integral(simulation, volume) - before, poured, 1e-12) << solver;
        while (simulation.time() < 0.03) simulation.step();
        const real left = integral(simulation, "hand_mass") / 1000;
        EXPECT_LT(left, poured - 0.25 * (D == 2 ? pi * 0.01 : 4 * pi / 3 * 1e-3)) << solver;
        EXPECT_NEAR(integral(simulation, volume) - before, left, 1e-12) << solver;
    }
}

TEST("smoke is poured and drained where the fluid carries some") {
    const std::string smoke = "initial.smoke = { name = \"constant\", value = 0.5 }\n";
    for (const char* kind : {"pour", "drain"}) {
        auto simulation = start(box<2>("mac", 0.01, smoke + hand(keyframe(0, kind, "[0.5, 0.5]", 0.2, "velocity = [0, 0]"))));
        const real before = integral(simulation, "total_smoke");
        for (int s = 0; s < 20; ++s) simulation.step();
        const real change = (integral(simulation, "total_smoke") - before) / (0.5 * pi * 0.04);
        EXPECT_GT(std::string(kind) == "pour" ? change : -change, 0.3);  // the kernel's mean is a third; soon it is full there
        EXPECT_LT(std::abs(change), 1);
    }
}

TEST_IN_2D_AND_3D("a run with a hand goes on from its checkpoint bit for bit") {
    for (const char* solver : {"mac", "mac_water", "pbf", "sph"}) {
        const std::string frames = keyframe(0, "push", list<D>(0.4, 0.5, 0.5), 0.2, "velocity = " + list<D>(0.5, 0.5, 0)) + ", " +
                                   keyframe(0.008, "pour", list<D>(0.2, 0.8, 0.5), 0.15, "velocity = " + list<D>(0, -0.5, 0));
        const std::string text = box<D>(solver, 0.002, hand(frames));
        auto whole = start(text), half = start(text);
        for (int s = 0; s < 8; ++s) whole.step();
        for (int s = 0; s < 3; ++s) half.step();
        Checkpoint checkpoint;
        half.save(checkpoint);
        auto again = start(text);
        again.restore(checkpoint);
        for (int s = 0; s < 5; ++s) again.step();
        EXPECT_EQ(state_of(whole), state_of(again)) << solver;
    }
}

TEST("keyframes added while a run goes on are those of the scene that names them, and survive a change of a key") {
    const std::string text = box<2>("pbf", 0.002, "effects.gravity.g = [0, -1]\n");
    auto live = start(text + hand(""));
    const auto act = [&](HandKind kind) {
        live.solver().hand()->keys.push_back({live.time(), kind, {{0.4, 0.5, 0}}, 0.2, {{0.5, 0, 0}}, 0});
        return live.time();
    };
    for (int s = 0; s < 3; ++s) live.step();
    const real from = act(HandKind::push);
    for (int s = 0; s < 3; ++s) live.step();
    const real turned = live.horizon();
    live.set_at(turned, {"effects.gravity.g", "[0, 3]"});
    for (int s = 0; s < 6; ++s) live.step();
    const real until = act(HandKind::off);
    for (int s = 0; s < 3; ++s) live.step();
    auto replay = start(
        text + fmt::format("changes = [ {{ time = {}, key = \"effects.gravity.g\", value = [0, 3] }} ]\n", turned) +
        hand(keyframe(from, "push", "[0.4, 0.5]", 0.2, "velocity = [0.5, 0]") + fmt::format(", {{ time = {}, kind = \"off\" }}", until)));
    for (int s = 0; s < 15; ++s) replay.step();
    EXPECT_EQ(state_of(live), state_of(replay));
}

TEST("devices and the reference refuse the hand by name, and keyframes that say too little or lie out of order are refused") {
    const auto said = [](const std::string& text) -> std::string {
        try {
            start(text);
        } catch (const BadInput& refused) {
            return refused.what();
        }
        return "accepted";
    };
    const std::string push = keyframe(0.5, "push", "[0.4, 0.5]", 0.2, "velocity = [0.5, 0]");
    EXPECT_NE(
        said(box<2>("pbf", 0.002, "scheme.backend = \"reference\"\n" + hand(push))).find("the backend reference has no effect \"hand\""),
        std::string::npos);
    EXPECT_NE(said(box<2>("pbf", 0.002, hand("{ time = 0.0, radius = 0.1 }"))).find("keyframes[0] has no \"centre\""), std::string::npos);
    EXPECT_NE(said(box<2>("pbf", 0.002, hand(push + ", { time = 0.1, kind = \"off\" }"))).find("before that of the keyframe above"),
              std::string::npos);
}

}  // namespace
