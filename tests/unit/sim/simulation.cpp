#include "sim/simulation.hpp"
#include "sim/steadiness.hpp"

#include "core/parallel.hpp"
#include "sim/registry.hpp"
#include "sim/requested_times.hpp"
#include "support/fake_solver.hpp"
#include "support/test.hpp"

#include <cmath>

namespace simulation_tests {

namespace {

using weir::real;
using weir::test::fake_simulation;

std::vector<real> times_of_frames(weir::Simulation& simulation) {
    std::vector<real> times{simulation.time()};
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.at_frame()) times.push_back(simulation.time());
    }
    return times;
}

TEST("with output.at = exact every frame and the end are hit: to the last bit or, where t + (T - t) rounds, to the one before") {
    auto simulation = fake_simulation("time = { end = 1.0 }\noutput = { every = 0.1, at = \"exact\" }");
    const auto times = times_of_frames(simulation);
    ASSERT_EQ(times.size(), 11u);
    for (std::size_t k = 0; k < times.size(); ++k) EXPECT_DOUBLE_EQ(times[k], 0.1 * static_cast<real>(k));
    EXPECT_EQ(simulation.frame(), 10);
}

TEST("a run whose last frame falls just before the end, by rounding, has no frame too many") {
    for (const std::string at : {"step", "exact"}) {
        auto simulation =
            fake_simulation("time = { end = 0.3 }\noutput = { every = 0.1, at = \"" + at + "\" }");  // 3 * 0.1 > 0.3 in doubles
        EXPECT_EQ(times_of_frames(simulation).size(), 4u) << at;
    }
}

TEST("a frame is the state after the first step that reaches its time, a step that reaches several is one frame, and the end is one") {
    auto simulation = fake_simulation("time = { end = 1.0 }\noutput = { every = 0.1 }");  // steps of 0.01 to 0.03 s
    std::vector<real> times{0}, before{0}, frames{0};
    while (!simulation.finished()) {
        before.push_back(simulation.time());
        simulation.step();
        times.push_back(simulation.time());
        if (simulation.at_frame()) frames.push_back(simulation.time());
    }
    std::vector<real> expected{0};
    for (int k = 1; k <= 10; ++k)
        for (std::size_t i = 1; i < times.size(); ++i)
            if (before[i] < k / 10.0 && times[i] >= k / 10.0) expected.push_back(times[i]);
    EXPECT_EQ(frames, expected);
    EXPECT_EQ(simulation.frame(), 10);
    auto often = fake_simulation("time = { end = 1.0 }\noutput = { every = 0.001 }");
    const std::size_t written = times_of_frames(often).size();
    EXPECT_EQ(written, static_cast<std::size_t>(often.steps()) + 1);
}

TEST("steps do not depend on frames: the same times, to the bit, with frames often, seldom and never") {
    const auto steps = [](const std::string& output) {
        auto simulation = fake_simulation("time = { end = 1.0 }\n" + output);
        std::vector<real> times;
        while (!simulation.finished()) simulation.step(), times.push_back(simulation.time());
        return times;
    };
    const auto never = steps("");
    for (const std::string every : {"0.001", "0.02", "0.1", "0.7", "5"}) EXPECT_EQ(steps("output.every = " + every), never) << every;
    EXPECT_NE(steps("output = { every = 0.1, at = \"exact\" }"), never);
    EXPECT_EQ(never.back(), 1.0);
}

TEST("times of frames and probes are the doubles of decimal products: three times 0.1 is 0.3") {
    for (int k = 0; k < 2000; ++k) {
        EXPECT_EQ(weir::sim::requested_time(0.1, k), k / 10.0);
        EXPECT_EQ(weir::sim::requested_time(0.609, k), k * 609 / 1000.0);
        EXPECT_EQ(weir::sim::requested_time(2.5e-5, k), k * 25 / 1e6);
    }
    EXPECT_NE(3 * 0.1, 0.3);
    EXPECT_EQ(weir::sim::requested_time(1.0 / 3, 5), 5 * (1.0 / 3));
    EXPECT_EQ(weir::sim::first_after(0.1, 0.3), 4);
    EXPECT_EQ(weir::sim::first_after(0.1, std::nextafter(0.3, 0)), 4);  // rounding is no difference
    EXPECT_EQ(weir::sim::first_after(0.1, 0.29), 3);
    EXPECT_EQ(weir::sim::first_after(1e-300, 1.0) > 0, true);
}

TEST("a fixed step is taken as given, and cut only before a frame or the end") {
    auto simulation = fake_simulation("time = { end = 0.25, dt = 0.1 }");
    EXPECT_EQ(simulation.step().dt, 0.1);
    EXPECT_EQ(simulation.step().dt, 0.1);
    EXPECT_NEAR(simulation.step().dt, 0.05, 1e-15);  // the rest
    EXPECT_TRUE(simulation.finished());
    EXPECT_EQ(simulation.steps(), 3);
}

TEST("a fixed step longer than the solver is stable for is taken in equal parts, and that is said once, with both numbers") {
    auto simulation = fake_simulation("time = { end = 1.0, dt = 0.1 }\nstable_dt = 0.03");
    EXPECT_EQ(simulation.next_dt(), 0.1 / 4);
    EXPECT_TRUE(simulation.warnings().empty());
    for (int s = 0; s < 3; ++s) EXPECT_EQ(simulation.step().dt, 0.1 / 4);
    ASSERT_EQ(simulation.warnings().size(), 2u);  // of the solver too
    const std::string& warning = simulation.warnings()[0];
    for (const char* part : {"time.dt", "0.1 s", "0.03 s", "so it says", "time.guard"})
        EXPECT_NE(warning.find(part), std::string::npos) << warning;
    EXPECT_EQ(simulation.warnings()[1], "fake.toml: concerned");
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.warnings().size(), 2u);
    EXPECT_DOUBLE_EQ(simulation.time(), 1.0);
}

TEST("a stable step is taken bit for bit as without the guard, and the guard can be put off") {
    auto stable = fake_simulation("time = { end = 1.0, dt = 0.1 }\nstable_dt = 0.1");
    EXPECT_EQ(stable.step().dt, 0.1);
    EXPECT_TRUE(stable.warnings().empty());
    auto off = fake_simulation("time = { end = 1.0, dt = 0.1, guard = \"off\" }\nstable_dt = 0.03");
    EXPECT_EQ(off.step().dt, 0.1);
    EXPECT_TRUE(off.warnings().empty());
}

/// 0.25 m of liquid in a box of 1 m, 16 cells a side, that moves down at so many m/s in steps of 0.02 s.
weir::Simulation falling(const std::string& solver, const std::string& speed, const std::string& more) {
    const std::string text = "solver = \"" + solver + "\"\ndim = 2\ngrid = { cells = [16, 16], size = [1, 1] }\n" +
                             "time = { end = 0.02, dt = 0.02 }\nfluid = { density = 1000.0 }\n" +
                             "liquid = [ { shape = \"box\", min = [0.25, 0.5], max = [0.75, 0.75] } ]\n" +
                             "initial.velocity = { name = \"constant\", value = [0, -" + speed + "] }\n" + more;
    return weir::Simulation(weir::scene::parse(text, "falling.toml", weir::sim::schemas()));
}

TEST("solvers name the step that they are stable for: two cells of water, half a support of sound, a support of a particle's way") {
    const real cell = 1.0 / 16, speed = 20;
    EXPECT_DOUBLE_EQ(falling("mac_water", "20", "").solver().stable_dt().dt, 2 * cell / speed);
    EXPECT_DOUBLE_EQ(falling("sph", "20", "scheme = { support = 4.0, sound_speed = 100.0 }").solver().stable_dt().dt,
                     2 * cell / (100 + speed));
    EXPECT_DOUBLE_EQ(falling("pbf", "20", "scheme.support = 2.0").solver().stable_dt().dt, 2 * cell / speed);
    EXPECT_EQ(falling("mac_water", "0.1", "").next_dt(), 0.02);  // far below its limit: as given
}

TEST("particles of SPH faster than three tenths of sound are remarked once, with their speed and that of sound") {
    auto fast = falling("sph", "20", "scheme.sound_speed = 50.0");
    while (!fast.finished()) fast.step();
    std::string all;
    for (const std::string& line : fast.warnings()) all += line + "\n";
    EXPECT_EQ(fast.warnings().size(), 2u) << all;  // and the step, taken in parts
    for (const char* part : {"moves at 20", "Mach 0.4", "sound of 50 m/s", "Mach 0.3"}) EXPECT_NE(all.find(part), std::string::npos) << all;
    auto slow = falling("sph", "20", "scheme.sound_speed = 200.0");
    while (!slow.finished()) slow.step();
    ASSERT_EQ(slow.warnings().size(), 1u);
    EXPECT_EQ(slow.warnings()[0].find("Mach"), std::string::npos);
}

TEST("sums of rounded fixed steps leave no sliver before the end: 1000 steps of 0.001 make 1 s") {
    auto simulation = fake_simulation("time = { end = 1.0, dt = 0.001 }\noutput = { every = 0.05 }");
    real smallest = 1;
    while (!simulation.finished()) smallest = std::min(smallest, simulation.step().dt);
    EXPECT_EQ(simulation.steps(), 1000);
    EXPECT_GT(smallest, 0.000999);
}

TEST("nor do a hundred thousand of them: what each rounds by adds up") {
    auto simulation = fake_simulation("time = { end = 500.0, dt = 0.005 }");
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.steps(), 100000);
}

TEST("an advised step that would leave a sliver is halved with the rest, so no step is below half the advice") {
    auto simulation = fake_simulation("time = { end = 1.0 }\noutput = { every = 0.033, at = \"exact\" }");
    while (!simulation.finished()) {
        const real advised = simulation.solver().advised_dt();
        const real remaining = std::min(0.033 * static_cast<real>(simulation.frame() + 1), 1.0) - simulation.time();
        const real dt = simulation.step().dt;
        EXPECT_GE(dt * (1 + 1e-9), std::min(remaining, advised / 2));
        EXPECT_LE(dt, advised * (1 + 1e-9));
    }
}

TEST("time.max_dt bounds the advised step") {
    auto simulation = fake_simulation("time = { end = 0.1, max_dt = 0.004 }");
    while (!simulation.finished()) EXPECT_LE(simulation.step().dt, 0.004 * (1 + 1e-9));
}

TEST("run_until stops exactly there, between frames as well") {
    auto simulation = fake_simulation("time = { end = 1.0 }\noutput = { every = 0.1 }");
    simulation.run_until(0.25);
    EXPECT_DOUBLE_EQ(simulation.time(), 0.25);
    EXPECT_EQ(simulation.frame(), 2);
    EXPECT_FALSE(simulation.at_frame());
}

TEST("what is steady neither rises nor falls") {
    auto early = weir::test::fake_simulation("time = { end = 1.0 }"), late = weir::test::fake_simulation("time = { end = 1.0 }");
    late.run_until(0.2);
    for (const bool falls : {true, false}) {  // its velocity is that of the start plus t everywhere
        auto kept = weir::sim::grid_velocity((falls ? late : early).fields());
        EXPECT_NEAR(weir::sim::change_and_keep((falls ? early : late).fields(), kept), 0.2, 1e-14) << falls;
    }
}

TEST("a run that is asked to ends when its flow is steady, with a frame, and goes on from its checkpoint in the same way") {
    // From rest, the flow between plates under an acceleration G nears its parabola by modes; of du/dt the slowest is left, 4/pi G
    // exp(-nu pi^2 t) in the middle of a gap of 1 m. On 16 cells its rate is (pi h)^2 / 12 = 3.2e-3 too low, by the Euler step
    // dt nu pi^2 / 2 = 2.5e-3 too high, and the bound is passed within a step, 1e-3 of the time: together below 1 %.
    const std::string scene =
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [4, 16], size = [0.25, 1.0], periodic = [\"x\"] }\n"
        "time = { end = 20.0, dt = 0.005, stop_when_steady = 0.01, guard = \"off\" }\nfluid = { viscosity = 0.1 }\n"
        "sides = { y_min = { kind = \"wall\", slip = \"no\" }, y_max = { kind = \"wall\", slip = \"no\" } }\n"
        "effects = { gravity = { g = [1.0, 0.0] }, viscosity = { scheme = \"explicit\" } }\n";
    weir::Simulation simulation(weir::scene::parse(scene, "plates.toml", weir::sim::schemas()));
    weir::Checkpoint early;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.steps() == 100) simulation.save(early);
    }
    const real exact = std::log(4 / weir::pi / 0.01) / (0.1 * weir::pi * weir::pi);
    EXPECT_TRUE(simulation.steady());
    EXPECT_TRUE(simulation.at_frame());
    EXPECT_NEAR(simulation.time(), exact, 0.01 * exact);
    weir::Simulation again(weir::scene::parse(scene, "plates.toml", weir::sim::schemas()));
    again.restore(early);
    while (!again.finished()) again.step();
    EXPECT_EQ(again.steps(), simulation.steps());
}

TEST("a field that is no longer finite is a numerical failure with quantity, step and time") {
    auto simulation = fake_simulation("fail_at = 3\ntime = { end = 1.0, dt = 0.1 }");
    simulation.step();
    simulation.step();
    try {
        simulation.step();
        FAIL() << "the NaN passed";
    } catch (const weir::NumericalFailure& failure) {
        EXPECT_EQ(failure.quantity, "pressure");
        EXPECT_EQ(failure.step, 3);
        EXPECT_NEAR(failure.time, 0.3, 1e-15);
    }
}

TEST_IN_2D_AND_3D("a restored simulation continues bit for bit: times, steps, frames, fields, probes") {
    const std::string scene =
        "time = { end = 0.5 }\noutput = { every = 0.07 }\nprobes = [ { name = \"m\", kind = \"integral\", field = \"mass\", every = 0.03 } "
        "]";
    auto whole = fake_simulation(scene, D), first = fake_simulation(scene, D), second = fake_simulation(scene, D);
    while (!whole.finished()) whole.step();
    for (int i = 0; i < 7; ++i) first.step();
    weir::Checkpoint state;
    first.save(state);
    second.restore(state);
    EXPECT_EQ(second.steps(), 7);
    while (!second.finished()) second.step();
    EXPECT_EQ(second.time(), whole.time());
    EXPECT_EQ(second.steps(), whole.steps());
    EXPECT_EQ(second.frame(), whole.frame());
    EXPECT_EQ(second.probe_series("m").times, whole.probe_series("m").times);
    EXPECT_EQ(second.probe_series("m").values, whole.probe_series("m").values);
    const auto a = whole.fields(), b = second.fields();
    for (std::size_t f = 0; f < a.fields.size(); ++f)
        for (std::size_t c = 0; c < a.fields[f].data.size(); ++c)
            EXPECT_TRUE(std::equal(a.fields[f].data[c].begin(), a.fields[f].data[c].end(), b.fields[f].data[c].begin()));
}

TEST("a checkpoint of another scene is refused as bad input") {
    auto flat = fake_simulation("time = { end = 0.5 }");
    EXPECT_THROW(flat.restore(weir::Checkpoint{}), weir::BadInput);
}

/// The threads that a solver is made and stepped with.
struct Counting : weir::test::FakeSolver {
    explicit Counting(const weir::scene::Scene& scene) : FakeSolver(scene), seen({weir::threads()}) {}
    weir::StepReport step(real dt) override {
        seen.push_back(weir::threads());
        return FakeSolver::step(dt);
    }
    std::vector<int> seen;
};

TEST("a small scene takes no more threads than it has work for, a large one all, and a number that was set is taken") {
    auto kinds = weir::test::fake_kinds();
    kinds[0].make = [](const weir::scene::Scene& scene, const weir::Partition&) { return std::make_unique<Counting>(scene); };
    const auto threads_of = [&](int cells) {
        const std::string text =
            "solver = \"fake\"\ndim = 2\ngrid = { cells = [" + std::to_string(cells) + ", 8], size = [1, 1] }\ntime = { end = 1 }";
        weir::Simulation simulation(weir::scene::parse(text, "fake.toml", {kinds[0].schema}), kinds);
        const int next = simulation.threads();
        simulation.step();
        const auto& seen = static_cast<const Counting&>(simulation.solver()).seen;
        EXPECT_EQ(next, seen.back());
        return seen;
    };
    const int available = std::max(1, omp_get_max_threads()), grain = weir::ProblemSizeScope::cells_per_thread / 8;
    weir::set_threads(0);
    EXPECT_EQ(weir::threads(), available);
    EXPECT_EQ(threads_of(8), (std::vector<int>{1, 1}));
    EXPECT_EQ(threads_of(2 * grain - 1), (std::vector<int>{1, 1}));
    EXPECT_EQ(threads_of(available * grain), (std::vector<int>{available, available}));
    EXPECT_EQ(weir::threads(), available);
    weir::set_threads(3);
    EXPECT_EQ(threads_of(8), (std::vector<int>{3, 3}));
    weir::set_threads(0);
}

}  // namespace

TEST("a run goes on until a finite time: NaN and infinity are refused at once, also of a change to come") {
    auto simulation = weir::test::fake_simulation("time = { end = 1.0 }", 2);
    for (const weir::real t : {weir::not_applicable, weir::infinity, -weir::infinity}) {
        EXPECT_THROW(simulation.run_until(t), weir::BadInput);
        EXPECT_THROW(simulation.set_at(t, {"time.end", "2"}), weir::BadInput);
    }
    EXPECT_THROW(simulation.step_until(weir::not_applicable), weir::BadInput);
    EXPECT_EQ(simulation.steps(), 0);
}

}  // namespace simulation_tests
