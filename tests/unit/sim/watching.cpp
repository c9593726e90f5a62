// Who watches a run changes nothing in it: frames, probes, checkpoints. And what is watched does not depend on restarts. For every solver.
#include "sim/loop.hpp"
#include "sim/registry.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>
#include <iterator>

namespace watching_tests {

namespace {

using namespace weir;

std::string bytes_of(const Solver& solver) {
    Checkpoint state;
    solver.save(state);
    const test::TemporaryFolder folder;
    state.write(folder.path() / "a");
    std::ifstream file(folder.path() / "a", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Simulation simulation_of(const std::string& scene, const std::string& more, const std::string& end = "0.3") {
    return Simulation(scene::parse(scene + "time.end = " + end + "\n" + more, "watched.toml", sim::schemas()));
}

struct Watched final : sim::Watcher {
    std::vector<real> steps;
    void on_step(const Simulation& simulation, const StepReport&, double) override { steps.push_back(simulation.time()); }
};

/// A small scene of each kind of solver, and probes of every kind that it has. Longer than 0.3 s takes 10 steps of any.
struct Case {
    std::string name, scene, probes;
};
const std::vector<Case>& cases() {
    const std::string box = "dim = 2\ngrid = { cells = [12, 12], size = [1, 1] }\ntime.max_dt = 0.03\n";
    const std::string pool = "liquid = [ { shape = \"box\", min = [0, 0], max = [0.5, 0.5] } ]\nfluid.density = 1000\n";
    const std::string falls = "effects.gravity.g = [0, -9.81]\n";
    const auto probe = [](const std::string& name, const std::string& what) {
        return "{ name = \"" + name + "\", every = 0.03, " + what + " }, ";
    };
    const std::string gauge = probe("gauge", "kind = \"gauge\", at = [0.3, 0]"), front = probe("front", "kind = \"front\"");
    const std::string wall = probe("wall", "kind = \"wall_pressure\", at = [0, 0.1]");
    const std::string pressure = probe("p", "kind = \"point\", field = \"pressure\", at = [0.2, 0.2]");
    const std::string energy = probe("ke", "kind = \"integral\", field = \"kinetic_energy\"");
    const std::string water = gauge + front + wall + energy;
    static const std::vector<Case> list{
        {"mac", "solver = \"mac\"\n" + box + falls + "initial.velocity = \"random\"\n", pressure + wall + energy},
        {"mac_water", "solver = \"mac_water\"\n" + box + pool + falls, water + pressure},
        {"tallcell", "solver = \"tallcell\"\n" + box + pool + falls, water + pressure},
        {"pbf", "solver = \"pbf\"\n" + box + pool + falls, gauge + front + energy},
        {"sph", "solver = \"sph\"\n" + box + pool + falls, water},
        {"heightfield", "solver = \"heightfield\"\n" + box + pool + falls, gauge + front + energy},
        {"transport",
         "solver = \"transport\"\n" + box +
             "flow = { name = \"constant\", value = [1, 0.3] }\ninitial.tracer = { name = \"ball\", centre = [0.5, 0.5], radius = 0.2, "
             "value "
             "= 1, outside = 0 }\n",
         probe("t", "kind = \"point\", field = \"tracer\", at = [0.55, 0.5]")},
        {"waves",
         "solver = \"waves\"\n" + box + falls + "waves = { model = \"sines\", trains = [ { amplitude = 0.01, wavelength = 1.0 } ] }\n",
         gauge},
    };
    return list;
}

TEST("steps and the state at the end are the same to the bit with frames often, seldom and never, with probes and with checkpoints") {
    for (const Case& c : cases()) {
        const auto run = [&](const std::string& more, std::int64_t checkpoint_every) {
            const test::TemporaryFolder folder;
            Simulation simulation = simulation_of(c.scene, more);
            Watched watcher;
            sim::LoopOptions options;
            options.folder = folder.path();
            options.checkpoint_every = checkpoint_every;
            sim::run(simulation, watcher, options);
            return std::pair{watcher.steps, bytes_of(simulation.solver())};
        };
        const auto alone = run("", 0);
        EXPECT_GT(alone.first.size(), 5u) << c.name;
        for (const std::string every : {"0.001", "0.02", "0.1", "5"})
            EXPECT_EQ(run("output.every = " + every + "\n", 0), alone) << c.name << every;
        EXPECT_EQ(run("probes = [ " + c.probes + "]\noutput.every = 0.07\n", 3), alone) << c.name;
    }
}

TEST("rows of probes are at the times that were asked for, and bit for bit the same over a restart after any step") {
    for (const Case& c : cases()) {
        const std::string probes = "probes = [ " + c.probes + "]\n";
        Simulation whole = simulation_of(c.scene, probes);
        while (!whole.finished()) whole.step();
        for (const std::int64_t steps : {std::int64_t{1}, whole.steps() / 3, whole.steps() / 2, whole.steps() - 1}) {
            Simulation first = simulation_of(c.scene, probes), second = simulation_of(c.scene, probes);
            while (first.steps() < steps) first.step();
            Checkpoint state;
            first.save(state);
            second.restore(state);
            while (!second.finished()) second.step();
            for (const ProbeSeries& series : whole.probes()) {
                ASSERT_EQ(series.times.size(), 11u) << c.name;
                for (int k = 0; k <= 10; ++k) EXPECT_EQ(series.times[static_cast<std::size_t>(k)], 3 * k / 100.0) << c.name;
                EXPECT_EQ(second.probe_series(series.name).times, series.times) << c.name << ' ' << series.name;
                EXPECT_EQ(second.probe_series(series.name).values, series.values) << c.name << ' ' << series.name << ' ' << steps;
            }
        }
    }
}

TEST("a run continued from the checkpoint at its end is bit for bit the run that had the later end") {
    for (const Case& c : cases()) {
        if (c.name == "pbf") continue;  // its even steps divide the whole run
        const test::TemporaryFolder folder;
        const std::string watched = "probes = [ " + c.probes + "]\noutput.every = 0.1\n";
        Simulation whole = simulation_of(c.scene, watched, "0.6"), first = simulation_of(c.scene, watched),
                   rest = simulation_of(c.scene, watched, "0.6");
        Watched watcher;
        sim::LoopOptions options;
        options.folder = folder.path();
        sim::run(whole, watcher, options);
        options.checkpoint_every = 1000;
        sim::run(first, watcher, options);
        rest.restore(Checkpoint::read(sim::checkpoint_file(folder.path())));
        options.restarted = true;
        sim::run(rest, watcher, options);
        EXPECT_EQ(first.time(), 0.3) << c.name;
        EXPECT_EQ(rest.steps(), whole.steps()) << c.name;
        EXPECT_EQ(rest.frame(), whole.frame()) << c.name;
        EXPECT_EQ(bytes_of(rest.solver()), bytes_of(whole.solver())) << c.name;
        for (const ProbeSeries& series : whole.probes())
            EXPECT_EQ(rest.probe_series(series.name).values, series.values) << c.name << series.name;
    }
}

}  // namespace

}  // namespace watching_tests
