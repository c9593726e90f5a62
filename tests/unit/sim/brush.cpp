// The brush: what it gives is what the fluid has got, it touches nothing beyond its brush, no target is faster than a cell a step, and what
// it pours and drains is counted.
#include "core/brush.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace brush_tests {

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
std::string brush(const std::string& frames) { return "effects.hand = { rate = 40, keyframes = [ " + frames + " ] }\n"; }

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

TEST_IN_2D_AND_3D("in a periodic box with fluxes the momentum of the fluid is what the brush gave, push and pull, after many steps") {
    const std::string frames = keyframe(0, "push", list<D>(0.4, 0.5, 0.5), 0.3, "velocity = " + list<D>(1, 0.5, -0.25)) + ", " +
                               keyframe(0.03, "pull", list<D>(0.6, 0.5, 0.5), 0.25, "speed = 1.0");
    auto simulation =
        start(box<D>("mac", 0.005, "scheme = { advection = \"conservative\", poisson = { tolerance = 1e-12 } }\n" + brush(frames), cells(D),
                     "", D == 2 ? periodic_2d : periodic_3d));
    for (int s = 0; s < 12; ++s) simulation.step();
    const Vec<D> given = vector<D>(simulation, "hand_impulse"), has = vector<D>(simulation, "momentum");
    EXPECT_GT(norm(given), 1);
    // Fluxes and pressure take from one face what they give to the next: what is left is rounding, of every face in every substep, of
    // values up to the largest speed: n faces x 3 substeps x 12 steps x a dozen operations x epsilon, of the momentum of all fluid at 1
    // m/s.
    EXPECT_LT(norm(has - given), std::pow(cells(D), D) * 36 * 12 * 2.2e-16 * 1000);
}

TEST_IN_2D_AND_3D("a ball of particles has the momentum that the brush gave it, to the single precision of its pairs") {
    for (const char* solver : {"pbf", "sph"}) {
        const real dt = solver == std::string("pbf") ? 0.005 : 0.0005;
        const std::string frames = keyframe(0, "push", list<D>(0.4, 0.5, 0.5), 0.2, "velocity = " + list<D>(1, 0.5, -0.25)) + ", " +
                                   keyframe(5 * dt, "pull", list<D>(0.6, 0.5, 0.5), 0.15, "speed = 0.5");
        auto simulation = start(box<D>(solver, dt, brush(frames)));
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
    for (const char* solver : {"mac_water", "tallcell"}) {
        const std::string frames = keyframe(0, "push", list<D>(0.5, 0.5, 0.5), 1, "velocity = " + list<D>(0.5, 0, 0));
        auto simulation = start(box<D>(solver, 0.005, brush(frames), 24));
        for (int s = 0; s < 8; ++s) simulation.step();
        const Vec<D> given = vector<D>(simulation, "hand_impulse"), has = vector<D>(simulation, "momentum");
        // A face is of the liquid or not, by its two cells: the surface is known to half a cell all around, and is not faster than the
        // brush.
        const real half_layer = (D == 2 ? 2 * pi * 0.3 : 4 * pi * 0.3 * 0.3) * 0.5 / 24;
        EXPECT_GT(norm(given), 2 * 1000 * half_layer * 0.5) << solver;
        EXPECT_LT(norm(has - given), 1000 * half_layer * 0.5) << solver;
    }
}

// Pressure takes from one face's volume what it gives to the next. The first step carries no momentum; what is left is the round-off of the
// sums over all faces, of at most 1000 kg at 1 m/s.
TEST_IN_2D_AND_3D("liquid and gas at rest have the momentum that one step of the brush gave them, each with its density") {
    const std::string frames = keyframe(0, "push", list<D>(0.3, 0.5, 0.5), 0.3, "velocity = " + list<D>(1, 0.5, -0.25));
    auto simulation = start(box<D>("two_phase", 0.002, "gas.density = 1.2\nscheme.poisson.tolerance = 1e-12\n" + brush(frames), cells(D),
                                   "", D == 2 ? periodic_2d : periodic_3d));
    simulation.step();
    const Vec<D> given = vector<D>(simulation, "hand_impulse"), has = vector<D>(simulation, "momentum");
    EXPECT_GT(given[0], 0.1);
    EXPECT_LT(norm(has - given), std::pow(cells(D), D) * 12 * 2.2e-16 * 1000);
}

/// A basin of water 0.5 m deep, 2 m long (and 1 m wide), round along x.
template <int D>
std::string basin(const std::string& model, const std::string& more) {
    return fmt::format(
        "solver = \"heightfield\"\ndim = {}\ngrid = {{ cells = {}, size = {}, periodic = [\"x\"] }}\ntime = {{ end = 1.0, dt = 0.005 }}\n"
        "fluid.density = 1000\nscheme.model = \"{}\"\ninitial.surface = \"0.5\"\neffects.gravity.g = {}\n{}\n",
        D, D == 2 ? "[48, 1]" : "[48, 1, 12]", list<D>(2, 1, 1), model, list<D>(0, -9.81, 0), more);
}

TEST_IN_2D_AND_3D("water on a level bed has the momentum that the brush gave it, and the volume that it poured less what it drained") {
    const std::string frames = keyframe(0, "push", list<D>(0.5, 9, 0.5), 0.4, "velocity = " + list<D>(0.4, 0, 0.1)) + ", " +
                               keyframe(0.05, "pour", list<D>(1.2, 9, 0.5), 0.3, "speed = 0.5, velocity = " + list<D>(0.2, 0, 0)) + ", " +
                               keyframe(0.1, "pull", list<D>(1, 9, 0.5), 0.4, "speed = 0.3") + ", " +
                               keyframe(0.15, "drain", list<D>(0.5, 9, 0.5), 0.3, "speed = 0.5");
    auto simulation = start(basin<D>("shallow_water", brush(frames)));
    const real before = integral(simulation, "volume");
    for (int s = 0; s < 40; ++s) simulation.step();
    // Fluxes take from one column what they give to the next; walls push along z: only the momentum along x is kept. Rounding: a thousand
    // operations on each of 600 columns, of 1,000 kg of water at 1 m/s.
    const real rounding = 1e3 * 600 * 2.2e-16 * 1000;
    EXPECT_GT(std::abs(integral(simulation, "hand_impulse_x")), 10);
    EXPECT_NEAR(integral(simulation, "momentum_x"), integral(simulation, "hand_impulse_x"), rounding);
    EXPECT_NEAR(integral(simulation, "volume") - before, integral(simulation, "hand_mass") / 1000, 1e-3 * rounding);
    EXPECT_NEAR(integral(simulation, "volume_balance"), before, 1e-3 * rounding);
    simulation = start(basin<D>("shallow_water", brush(keyframe(0, "pour", list<D>(1, 0, 0.5), 0.3, "speed = 0.5"))));
    for (int s = 0; s < 10; ++s) simulation.step();
    // speed x time x the integral of (1 - r^2/R^2)^2: 16/15 R on a line, pi R^2/3 on a disk; by columns of which 7 make a radius: their
    // rectangle rule on this smooth hump is good to a per cent.
    const real poured = 0.5 * 0.05 * (D == 2 ? 16.0 / 15 * 0.3 : pi * 0.09 / 3);
    EXPECT_NEAR(integral(simulation, "hand_mass") / 1000, poured, 0.01 * poured);
}

TEST_IN_2D_AND_3D("columns that pull their neighbours are poured and drained, never below half their depth, and the rest is refused") {
    const std::string frames = keyframe(0, "pour", list<D>(1.2, 0, 0.5), 0.3, "speed = 0.5") + ", " +
                               keyframe(0.05, "drain", list<D>(0.5, 0, 0.5), 0.3, "speed = 50.0");
    auto simulation = start(basin<D>("columns", brush(frames)));
    const real before = integral(simulation, "volume");
    for (int s = 0; s < 10; ++s) simulation.step();
    const real poured = integral(simulation, "hand_mass") / 1000;
    EXPECT_NEAR(integral(simulation, "volume") - before, poured, 1e-11);
    EXPECT_GT(poured, 0.9 * 0.5 * 0.05 * (D == 2 ? 16.0 / 15 * 0.3 : pi * 0.09 / 3));
    for (int s = 0; s < 2; ++s) simulation.step();
    EXPECT_LT(integral(simulation, "hand_mass") / 1000, poured);
    EXPECT_NEAR(integral(simulation, "volume_balance"), before, 1e-11);
    const FieldSet fields = simulation.fields();
    for (const real depth : fields.find("", "depth")->data[0])
        EXPECT_GT(depth, 0.1);  // half of 0.5 m, and the wave that runs into the hole
    EXPECT_THROW(start(basin<D>("columns", brush(keyframe(0, "push", list<D>(1, 0, 0.5), 0.3, "velocity = " + list<D>(1, 0, 0))))),
                 BadInput);
}

TEST("what is poured on tall cells and drained from them is the volume that they gain and lose") {
    const std::string frames =
        keyframe(0, "pour", "[0.8, 0.7]", 0.15, "velocity = [0, -0.5]") + ", " + keyframe(0.02, "drain", "[0.4, 0.2]", 0.15, "speed = 0.0");
    auto simulation = start(
        "solver = \"tallcell\"\ndim = 2\ngrid = { cells = [48, 48], size = [1, 1] }\ntime = { end = 1.0, dt = 0.002 }\nfluid.density = "
        "1000\n"
        "scheme.layers = 8\neffects.gravity.g = [0, -9.81]\nliquid = [ { shape = \"box\", min = [0, 0], max = [1, 0.5] } ]\n" +
        brush(frames));
    const real before = integral(simulation, "volume");
    while (simulation.time() < 0.019) simulation.step();
    const real poured = integral(simulation, "hand_mass") / 1000, ball = pi * 0.15 * 0.15;
    // While it is poured the brush stays full: the ball, and what falls out of it in 0.02 s, at most 0.5 m/s over its width.
    EXPECT_GT(poured, 0.97 * ball);
    EXPECT_LT(poured, ball + 0.3 * (0.5 + 9.81 * 0.02) * 0.02 + 0.02 * ball);
    // The level set keeps a round drop's volume to a per cent (volume.drift of the cases).
    EXPECT_NEAR(integral(simulation, "volume") - before, poured, 0.01 * (before + poured));
    EXPECT_LT(integral(simulation, "hand_impulse_y"), -0.4 * 1000 * ball);
    while (simulation.time() < 0.021) simulation.step();
    EXPECT_NEAR(integral(simulation, "hand_mass") / 1000, poured - ball, 0.03 * ball);
}

TEST("a heated brush gives the heat that the fluid has more, comes to its temperature and no further, in every solver with heat") {
    for (const char* solver : {"mac", "mac_water", "pbf", "sph"}) {
        const real dt = solver == std::string("sph") ? 0.0005 : 0.005;
        const std::string warm = "substance = \"water\"\ninitial.temperature = { name = \"constant\", value = 300.0 }\n";
        auto simulation = start(box<2>(solver, dt, warm + brush(keyframe(0, "heat", "[0.5, 0.5]", 0.2, "temperature = 340.0"))));
        const real before = integral(simulation, "heat");
        for (int s = 0; s < 20; ++s) simulation.step();
        const real given = integral(simulation, "hand_heat");
        // Of the water under the brush, pi R^2 x 1,000 kg at 4.2 kJ/(kg K), warmed by 40 K at the most.
        EXPECT_LT(given, 1000 * pi * 0.04 * 4200 * 40) << solver;
        EXPECT_GT(given, 0.1 * (1 - std::exp(-40 * 20 * dt)) * 1000 * pi * 0.04 * 4200 * 40 / 3) << solver;  // the kernel's mean is a third
        EXPECT_NEAR(integral(simulation, "heat") - before, given, 1e-9 * before) << solver;
        EXPECT_NEAR(integral(simulation, "heat_added"), given, 1e-9 * before) << solver;
        const FieldSet fields = simulation.fields();
        const auto& T = fields.find("temperature")->data[0];
        const real hottest = *std::max_element(T.begin(), T.end());
        EXPECT_LT(hottest, 340.001) << solver;
        EXPECT_GT(hottest, 300 + 30 * (1 - std::exp(-40 * 20 * dt))) << solver;
    }
}

TEST_IN_2D_AND_3D("a body in the air follows the brush as a damped spring does, and has the momentum that it gave") {
    const std::string scene = fmt::format(
        "liquid = [ {{ shape = \"box\", min = {}, max = {} }} ]\n"
        "bodies = [ {{ shape = \"sphere\", centre = {}, radius = 0.1, density = 500.0 }} ]\n",
        list<D>(0, 0, 0), list<D>(1, 0.2, 1), list<D>(0.4, 0.7, 0.5));
    for (const std::string solver : {"mac_water", "pbf", "sph"}) {
        std::string text = box<D>(solver, 0.002, brush(keyframe(0, "grab", list<D>(0.6, 0.6, 0.5), 0.1, "body = 0")) + scene);
        text.erase(text.find("liquid"), text.find('\n', text.find("liquid")) - text.find("liquid") + 1);
        auto simulation = start(text);
        const auto at = [&](int a) { return simulation.fields().find("bodies", "position")->data[static_cast<std::size_t>(a)][0]; };
        for (int s = 0; s < 50; ++s) simulation.step();
        const real mass = 500 * (D == 2 ? pi * 0.01 : 4 * pi / 3 * 1e-3);
        const FieldSet fields = simulation.fields();
        for (int a = 0; a < D; ++a)
            EXPECT_NEAR(integral(simulation, std::string("hand_impulse_") + "xyz"[a]),
                        mass * fields.find("bodies", "velocity")->data[static_cast<std::size_t>(a)][0], 1e-9);
        // omega = rate/2 = 20 / s: what is left of the way is (1 + omega t) exp(-omega t), 0.406 at 0.1 s; backward Euler is late by a step
        // or so, omega^2 t dt / (1 + omega t) = 2.7% of what is left.
        const real left = (1 + 20 * 0.1) * std::exp(-20 * 0.1);
        EXPECT_NEAR((0.6 - at(0)) / 0.2, left, 0.05 * left);
        EXPECT_NEAR((at(1) - 0.6) / 0.1, left, 0.05 * left);
        for (int s = 0; s < 200; ++s) simulation.step();
        EXPECT_NEAR(at(0), 0.6, 0.2 * 0.02);  // (1 + 10) exp(-10) = 5e-4 of the way
        EXPECT_THROW(start(box<D>(solver, 0.002, brush(keyframe(0, "grab", list<D>(0.6, 0.6, 0.5), 0.1, "body = 1")) + scene)), BadInput);
        EXPECT_THROW(start(box<D>(solver, 0.002, brush(keyframe(0, "grab", list<D>(0.6, 0.6, 0.5), 0.1, "body = 0")))), BadInput);
    }
}

TEST_IN_2D_AND_3D("a brush that covers no fluid, or is off, changes no bit") {
    for (const char* solver : {"mac_water", "tallcell", "pbf", "sph"}) {
        auto off = start(box<D>(solver, 0.002, brush("{ time = 0.0, kind = \"off\" }")));
        auto away =
            start(box<D>(solver, 0.002, brush(keyframe(0, "push", list<D>(0.08, 0.08, 0.08), 0.08, "velocity = " + list<D>(1, 1, 1)))));
        for (int s = 0; s < 3; ++s) off.step(), away.step();
        EXPECT_EQ(state_of(off), state_of(away)) << solver;
        EXPECT_EQ(integral(away, "hand_mass"), 0);
    }
}

TEST_IN_2D_AND_3D("beyond the brush no particle is touched in the step in which it pushes") {
    const auto frames = [](const char* kind) {
        return brush(keyframe(0, kind, list<D>(0.5, 0.5, 0.5), 0.15, "velocity = " + list<D>(1, 0, 0)));
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
            start(box<2>(solver, dt, brush(keyframe(0, "push", "[0.5, 0.5]", 0.2, "velocity = [1e6, 0]")), cells(2), ", guard = \"off\""));
        simulation.step();
        EXPECT_LE(integral(simulation, std::string(solver) == "mac_water" ? "momentum_x" : "max_speed") /
                      (std::string(solver) == "mac_water" ? 1000 * pi * 0.3 * 0.3 : 1),
                  1.01 * h / dt)
            << solver;  // the pressure may turn it aside, not speed it up
        EXPECT_GT(integral(simulation, "hand_impulse_x"), 0) << solver;
    }
}

TEST_IN_2D_AND_3D("what is poured is there, a drain takes it out, and the balance includes both") {
    for (const char* solver : {"mac_water", "pbf", "sph"}) {
        const real dt = 0.002;
        const std::string frames = keyframe(0, "pour", list<D>(0.2, 0.8, 0.5), 0.15, "velocity = " + list<D>(0, -0.5, 0)) + ", " +
                                   keyframe(0.02, "drain", list<D>(0.5, 0.5, 0.5), 0.1, "speed = 0.0");
        auto simulation = start(box<D>(solver, dt, brush(frames)));
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
        auto simulation = start(box<2>("mac", 0.01, smoke + brush(keyframe(0, kind, "[0.5, 0.5]", 0.2, "velocity = [0, 0]"))));
        const real before = integral(simulation, "total_smoke");
        for (int s = 0; s < 20; ++s) simulation.step();
        const real change = (integral(simulation, "total_smoke") - before) / (0.5 * pi * 0.04);
        EXPECT_GT(std::string(kind) == "pour" ? change : -change, 0.3);  // the kernel's mean is a third; soon it is full there
        EXPECT_LT(std::abs(change), 1);
    }
}

TEST_IN_2D_AND_3D("a run with a brush goes on from its checkpoint bit for bit") {
    for (const char* solver : {"mac", "mac_water", "tallcell", "pbf", "sph"}) {
        const std::string frames = keyframe(0, "push", list<D>(0.4, 0.5, 0.5), 0.2, "velocity = " + list<D>(0.5, 0.5, 0)) + ", " +
                                   keyframe(0.008, "pour", list<D>(0.2, 0.8, 0.5), 0.15, "velocity = " + list<D>(0, -0.5, 0));
        const std::string text = box<D>(solver, 0.002, brush(frames));
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
    auto live = start(text + brush(""));
    const auto act = [&](BrushKind kind) {
        live.solver().brush()->keys.push_back({live.time(), kind, {{0.4, 0.5, 0}}, 0.2, {{0.5, 0, 0}}, 0});
        return live.time();
    };
    for (int s = 0; s < 3; ++s) live.step();
    const real from = act(BrushKind::push);
    for (int s = 0; s < 3; ++s) live.step();
    const real turned = live.horizon();
    live.set_at(turned, {"effects.gravity.g", "[0, 3]"});
    for (int s = 0; s < 6; ++s) live.step();
    const real until = act(BrushKind::off);
    for (int s = 0; s < 3; ++s) live.step();
    auto replay = start(
        text + fmt::format("changes = [ {{ time = {}, key = \"effects.gravity.g\", value = [0, 3] }} ]\n", turned) +
        brush(keyframe(from, "push", "[0.4, 0.5]", 0.2, "velocity = [0.5, 0]") + fmt::format(", {{ time = {}, kind = \"off\" }}", until)));
    for (int s = 0; s < 15; ++s) replay.step();
    EXPECT_EQ(state_of(live), state_of(replay));
}

TEST("devices and the reference refuse the brush by name, and keyframes that say too little or lie out of order are refused") {
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
        said(box<2>("pbf", 0.002, "scheme.backend = \"reference\"\n" + brush(push))).find("the backend reference has no effect \"hand\""),
        std::string::npos);
    EXPECT_NE(said(box<2>("pbf", 0.002, brush(keyframe(0, "heat", "[0.4, 0.5]", 0.2, "temperature = 300.0"))))
                  .find("no action \"heat\" in this scene"),
              std::string::npos);
    EXPECT_NE(said(box<2>("pbf", 0.002, brush("{ time = 0.0, radius = 0.1 }"))).find("keyframes[0] has no \"centre\""), std::string::npos);
    EXPECT_NE(said(box<2>("pbf", 0.002, brush(push + ", { time = 0.1, kind = \"off\" }"))).find("before that of the previous keyframe"),
              std::string::npos);
}

}  // namespace

}  // namespace brush_tests
