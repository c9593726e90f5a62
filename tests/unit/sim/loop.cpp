#include "sim/loop.hpp"

#include "sim/probe_files.hpp"
#include "sim/run_id.hpp"
#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>
#include <iterator>

namespace loop_tests {

namespace {

using weir::real;
using weir::test::fake_simulation;
using weir::test::TemporaryFolder;

/// Counts what it is told.
struct Counter final : weir::sim::Watcher {
    void on_step(const weir::Simulation&, const weir::StepReport&, double) override { ++steps; }
    void on_frame(const weir::Simulation& simulation) override { frames.push_back(simulation.time()); }
    int steps = 0;
    std::vector<real> frames;
};

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

const std::string scene = "time = { end = 1.0 }\noutput = { every = 0.25, at = \"exact\" }\n";

TEST("a run tells of each step, and of frames at the start, at each output time and at the end") {
    auto simulation = fake_simulation(scene);
    Counter counter;
    EXPECT_EQ(weir::sim::run(simulation, counter, {}), weir::sim::Ending::finished);
    EXPECT_EQ(counter.steps, simulation.steps());
    EXPECT_EQ(counter.frames, (std::vector<real>{0, 0.25, 0.5, 0.75, 1.0}));
}

TEST("checkpoints of a run have its id, which is that of the scene as understood: a comment is no other scene, another end is") {
    auto simulation = fake_simulation(scene), same = fake_simulation(scene + "# a comment\n");
    EXPECT_EQ(weir::sim::run_id(simulation.scene()), weir::sim::run_id(same.scene()));
    EXPECT_NE(weir::sim::run_id(simulation.scene()), weir::sim::run_id(fake_simulation("time = { end = 2.0 }").scene()));
    Counter counter;
    for (const int every : {3, 1000}) {  // the second at the end: the state before the steps that were shortened for it
        TemporaryFolder folder;
        auto run = fake_simulation(scene);
        weir::sim::LoopOptions options;
        options.folder = folder;
        options.checkpoint_every = every;
        options.run = "0123";
        weir::sim::run(run, counter, options);
        EXPECT_EQ(weir::sim::run_id_of(weir::Checkpoint::read(weir::sim::checkpoint_file(folder))), "0123");
    }
}

TEST("asked once to stop, a run ends with its next frame; asked twice, with the step; both save where they continue bit for bit") {
    for (const int requests : {1, 2}) {
        TemporaryFolder folder;
        auto whole = fake_simulation(scene), simulation = fake_simulation(scene), continued = fake_simulation(scene);
        Counter counter;
        weir::sim::run(whole, counter, {});
        weir::sim::LoopOptions options;
        options.folder = folder;
        options.stop_requests = [&] { return simulation.steps() >= 3 ? requests : 0; };
        EXPECT_EQ(weir::sim::run(simulation, counter, options), weir::sim::Ending::interrupted);
        EXPECT_EQ(simulation.at_frame(), requests == 1);
        EXPECT_EQ(simulation.steps() == 3, requests == 2);
        continued.restore(weir::Checkpoint::read(weir::sim::checkpoint_file(folder)));
        Counter rest;
        weir::sim::LoopOptions restarted;
        restarted.restarted = true;
        weir::sim::run(continued, rest, restarted);
        EXPECT_EQ(continued.time(), whole.time());
        EXPECT_EQ(continued.steps(), whole.steps());
        EXPECT_EQ(continued.solver().advised_dt(), whole.solver().advised_dt());
        EXPECT_NE(rest.frames.front(), simulation.at_frame() ? simulation.time() : -1);  // no frame is told twice
    }
}

TEST("at a numerical failure the last good state is saved, and the message tells step, time, quantity and file") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("fail_at = 30\n" + scene);
    Counter counter;
    weir::sim::LoopOptions options;
    options.folder = folder;
    try {
        weir::sim::run(simulation, counter, options);
        FAIL() << "the NaN passed";
    } catch (const weir::NumericalFailure& failure) {
        const std::string text = failure.what();
        EXPECT_EQ(failure.step, 30);
        EXPECT_NE(text.find("step 30, t = "), std::string::npos) << text;
        EXPECT_NE(text.find("pressure is no longer finite"), std::string::npos) << text;
        EXPECT_NE(text.find(weir::sim::last_good_file(folder).string()), std::string::npos) << text;
    }
    auto good = fake_simulation(scene);
    good.restore(weir::Checkpoint::read(weir::sim::last_good_file(folder)));
    EXPECT_GT(good.steps(), 0);
    EXPECT_LT(good.steps(), 30);
    EXPECT_TRUE(good.at_frame());
}

TEST("a time step that vanishes is a failure like any other: step, time, quantity, and the last good state") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("stall_at = 20\n" + scene);
    Counter counter;
    weir::sim::LoopOptions options;
    options.folder = folder;
    try {
        weir::sim::run(simulation, counter, options);
        FAIL() << "time stood still";
    } catch (const weir::NumericalFailure& failure) {
        const std::string text = failure.what();
        EXPECT_EQ(failure.quantity, "time step");
        EXPECT_EQ(failure.step, 21);
        EXPECT_EQ(failure.time, simulation.time());
        EXPECT_GT(failure.time, 0);
        EXPECT_NE(text.find("step 21, t = "), std::string::npos) << text;
        EXPECT_NE(text.find("time step: the advised time step is 1e-20 s (the longest was 0.0"), std::string::npos) << text;
        EXPECT_NE(text.find("time no longer advances"), std::string::npos) << text;
        // The fake's velocity along an axis is (a + 1) x_a + t: fastest where y is 1, of cells the upper row's face.
        EXPECT_NE(text.find("the fastest flow moves at 2."), std::string::npos) << text;
        EXPECT_NE(text.find("m/s at [0.06"), std::string::npos) << text;
        EXPECT_NE(text.find("(cell 0, 8)"), std::string::npos) << text;
        // Its pressure is 3 x - 2 y.
        EXPECT_NE(text.find("the largest pressure is 2.69 Pa at [0.9375, 0.0625] m (cell 7, 0)"), std::string::npos) << text;
    }
    EXPECT_TRUE(std::filesystem::exists(weir::sim::last_good_file(folder)));
}

TEST("a step that has fallen to a millionth of what was wanted, and a billionth of the run, ends it") {
    auto simulation = fake_simulation("stable_dt = 1e-13\n" + scene);
    try {
        simulation.step();
        FAIL() << "it would take a hundred thousand years";
    } catch (const weir::NumericalFailure& failure) {
        EXPECT_EQ(failure.step, 1);
        EXPECT_NE(std::string(failure.what()).find("the longest stable step is 1e-13 s (the longest was 0.0"), std::string::npos)
            << failure.what();
    }
    auto slow = fake_simulation("stable_dt = 1e-6\n" + scene);  // ten thousand parts are a nuisance, no end
    EXPECT_NO_THROW(slow.step());
}

TEST("checkpoints are saved every so many steps, and at the end, so that a later end can be asked for") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0, dt = 0.125 }");  // eighths add up without rounding: none is shortened
    Counter counter;
    weir::sim::LoopOptions options;
    options.folder = folder;
    options.checkpoint_every = 3;
    weir::sim::run(simulation, counter, options);
    EXPECT_EQ(weir::Checkpoint::read(weir::sim::checkpoint_file(folder)).get_value<std::int64_t>("sim.steps"), 8);
}

TEST("a run continued beyond its end is bit for bit the run that had the later end: steps advised and given, frames at steps and exact") {
    const std::string probe = "probes = [ { name = \"m\", kind = \"integral\", field = \"mass\", every = 0.03 } ]\n";
    for (const std::string step : {"", ", dt = 0.01", ", dt = 0.1", ", dt = 0.07"})
        for (const std::string output : {"", "output.every = 0.1\n", "output = { every = 0.1, at = \"exact\" }\n"}) {
            TemporaryFolder folder;
            const auto until = [&](const std::string& end) {
                return fake_simulation("time = { end = " + end + step + " }\n" + probe + output);
            };
            auto whole = until("0.6"), first = until("0.3"), same = until("0.3"), rest = until("0.6");
            Counter counter;
            weir::sim::run(whole, counter, {});
            weir::sim::LoopOptions options;
            options.folder = folder;
            options.checkpoint_every = 1000;
            weir::sim::run(first, counter, options);
            EXPECT_EQ(first.time(), 0.3);
            const auto state = weir::Checkpoint::read(weir::sim::checkpoint_file(folder));
            same.restore(state);
            EXPECT_TRUE(same.finished()) << step << output;  // nothing is left to do
            rest.restore(state);
            options.restarted = true;
            weir::sim::run(rest, counter, options);
            EXPECT_EQ(rest.steps(), whole.steps()) << step << output;
            EXPECT_EQ(rest.time(), whole.time()) << step << output;
            EXPECT_EQ(rest.frame(), whole.frame()) << step << output;
            EXPECT_EQ(rest.solver().advised_dt(), whole.solver().advised_dt()) << step << output;  // of all steps so far
            EXPECT_EQ(rest.probe_series("m").times, whole.probe_series("m").times) << step << output;
            EXPECT_EQ(rest.probe_series("m").values, whole.probe_series("m").values) << step << output;
        }
}

TEST("probe files appended to step by step equal those written at once, and hold every digit") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 0.1 }\nprobes = [ { name = \"m\", kind = \"integral\", field = \"mass\" } ]");
    weir::sim::ProbeFiles growing(folder.path() / "a");
    while (!simulation.finished()) {
        simulation.step();
        growing.update(simulation.probes());
    }
    weir::sim::ProbeFiles(folder.path() / "b").update(simulation.probes());
    const std::string text = text_of(folder.path() / "a/m.csv");
    EXPECT_EQ(text, text_of(folder.path() / "b/m.csv"));
    EXPECT_NE(text.find("t [s],mass [kg]\n0,1.3\n"), std::string::npos) << text;
    const std::size_t last = text.rfind(',');
    EXPECT_EQ(std::stod(text.substr(last + 1)), simulation.probe_series("m").values.back()[0]);
}

}  // namespace

}  // namespace loop_tests
