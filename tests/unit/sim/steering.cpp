// Keys that change while a run goes on: a change is a restart with another --set, at its time exactly, and a run that was changed by hand
// is repeated bit for bit by a scene that names the changes.
#include "scene/steer.hpp"
#include "sim/registry.hpp"
#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace steering_tests {

namespace {

using namespace weir;
using test::fake_simulation;

scene::Scene parsed(const std::string& text, const std::vector<scene::Override>& set = {}) {
    return scene::parse(text, "steered.toml", sim::schemas(), set);
}

std::string bytes_of(const Checkpoint& checkpoint) {
    test::TemporaryFolder folder;
    checkpoint.write(folder.path() / "a");
    std::ifstream file(folder.path() / "a", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
std::string state_of(const Simulation& simulation) {
    Checkpoint state;
    simulation.solver().save(state);
    return bytes_of(state);
}
Simulation finished(Simulation simulation) {
    while (!simulation.finished()) simulation.step();
    return simulation;
}
Simulation restarted(const Simulation& simulation, const std::vector<scene::Override>& set = {}) {
    Checkpoint checkpoint;
    simulation.save(checkpoint);
    Simulation again(scene_of(checkpoint, set));
    again.restore(checkpoint);
    return again;
}

/// A small scene of each kind of solver that steers, and what steers it.
struct Case {
    std::string scene, key, before, after;
};
const std::vector<Case>& cases() {
    const std::string box = "dim = 2\ngrid = { cells = [16, 16], size = [1, 1] }\ntime = { end = 0.12 }\n";
    const std::string pool = "liquid = [ { shape = \"box\", min = [0, 0], max = [0.5, 0.5] } ]\nfluid.density = 1000\n";
    const std::string falls = "effects.gravity.g = [0, -9.81]\n";
    static const std::vector<Case> list{
        {"solver = \"mac\"\n" + box + falls + "initial.velocity = \"random\"\neffects.viscosity = {}\nfluid.viscosity = 0.01\n",
         "fluid.viscosity", "0.01", "0.1"},
        {"solver = \"mac_water\"\n" + box + pool + falls, "effects.gravity.g", "[0, -9.81]", "[5, 3]"},
        {"solver = \"tallcell\"\n" + box + pool + falls, "effects.gravity.g", "[0, -9.81]", "[0, -5]"},
        {"solver = \"pbf\"\n" + box + pool + falls + "scheme.iterations = 2\n", "scheme.iterations", "2", "5"},
        {"solver = \"sph\"\n" + box + pool + falls, "effects.gravity.g", "[0, -9.81]", "[5, 3]"},
        {"solver = \"heightfield\"\n" + box + pool + falls, "effects.gravity.g", "[0, -9.81]", "[0, -5]"},
    };
    return list;
}
std::string change(real time, const std::string& key, const std::string& value) {
    return fmt::format("{{ time = {}, key = \"{}\", value = {} }}", time, key, value);
}

TEST("a change in the scene is met exactly, and is a restart with another --set at that time") {
    for (const Case& c : cases()) {
        const auto changed = finished(Simulation(parsed(c.scene + "changes = [ " + change(0.05, c.key, c.after) + " ]\n")));
        Simulation first(parsed(c.scene));
        first.run_until(0.05);
        EXPECT_EQ(state_of(changed), state_of(finished(restarted(first, {{c.key, c.after}})))) << c.scene;
        Simulation by_call(parsed(c.scene));
        by_call.run_until(0.05);
        by_call.set({c.key, c.after});
        EXPECT_EQ(state_of(changed), state_of(finished(std::move(by_call)))) << c.scene;
        Simulation never(parsed(c.scene));
        never.run_until(0.05);
        EXPECT_NE(state_of(changed), state_of(finished(std::move(never)))) << c.scene << " does not feel " << c.key;
    }
}

TEST("a change to what a key already is leaves every bit, though the solver was made anew") {
    for (const Case& c : cases()) {
        Simulation plain(parsed(c.scene)), set(parsed(c.scene));
        plain.run_until(0.05), set.run_until(0.05);
        set.set({c.key, c.before});
        EXPECT_EQ(state_of(finished(std::move(plain))), state_of(finished(std::move(set)))) << c.scene;
    }
}

TEST("a checkpoint between two changes carries which were met; from it the run goes on bit for bit, from the file or from itself") {
    for (const Case& c : cases()) {
        const std::string text =
            c.scene + "changes = [ " + change(0.03, c.key, c.after) + ", " + change(0.09, c.key, c.before) + " ]\noutput.every = 0.06\n";
        Simulation half(parsed(text));
        while (half.frame() < 1) half.step();
        Checkpoint checkpoint;
        half.save(checkpoint);
        Simulation from_file(parsed(text));
        from_file.restore(checkpoint);
        const auto whole = state_of(finished(Simulation(parsed(text))));
        EXPECT_EQ(whole, state_of(finished(restarted(half)))) << c.scene;
        EXPECT_EQ(whole, state_of(finished(std::move(from_file)))) << c.scene;
    }
}

TEST("a scene without changes keeps none in its checkpoint") {
    Checkpoint checkpoint;
    fake_simulation("time = { end = 1.0 }").save(checkpoint);
    EXPECT_FALSE(checkpoint.has("sim.changed"));
}

TEST("steps meet the time of a change and are cut for nothing else; two at one time act in their order") {
    auto simulation = fake_simulation("time = { end = 1.0, dt = 0.1 }\nchanges = [ " + change(0.25, "time.dt", "0.5") + ", " +
                                      change(0.25, "time.dt", "0.2") + " ]");
    std::vector<real> times;
    while (!simulation.finished()) simulation.step(), times.push_back(simulation.time());
    ASSERT_EQ(times.size(), 7u);
    EXPECT_EQ(times[2], 0.25);
    EXPECT_DOUBLE_EQ(times[3], 0.45);
    EXPECT_EQ(simulation.frame(), 1);  // a change is no frame
}

TEST("a run that is steered while it goes on is repeated by the scene that names what was done, step by step") {
    // the fake's next step depends on every bit of the steps before it
    auto live = fake_simulation("time = { end = 1e6 }\noutput = { every = 0.1 }");
    std::string named;
    for (const auto& [steps, value] : {std::pair{7, "0.013"}, {4, "0.05"}, {1, "0.002"}, {30, "0.02"}}) {
        for (int s = 0; s < steps; ++s) live.step();
        const real when = live.horizon();
        live.set_at(when, {"time.max_dt", value});
        named += (named.empty() ? "" : ", ") + fmt::format("{{ time = {}, key = \"time.max_dt\", value = {} }}", when, value);
    }
    for (int s = 0; s < 100; ++s) live.step();
    const real end = live.horizon();
    live.set("time.end", end);
    live = finished(std::move(live));
    EXPECT_EQ(live.time(), end);
    const auto replay =
        finished(fake_simulation(fmt::format("time = {{ end = {} }}\noutput = {{ every = 0.1 }}\nchanges = [ {} ]", end, named)));
    EXPECT_EQ(replay.steps(), live.steps());
    EXPECT_EQ(replay.frame(), live.frame());
    EXPECT_EQ(state_of(replay), state_of(live));
}

std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const BadInput& refused) {
        return refused.what();
    }
    return "accepted";
}

TEST("what cannot change is refused with the reason, what is out of range as in a file; and all stays as it was") {
    Simulation simulation(parsed(cases()[3].scene));
    simulation.run_until(0.02);
    const auto before = state_of(simulation);
    const auto expect = [&](const scene::Override& what, const std::string& says) {
        const auto said = refusal([&] { simulation.set(what); });
        EXPECT_NE(said.find(says), std::string::npos) << what.key << " = " << what.value << ": " << said;
    };
    expect({"grid.cells", "[8, 8]"}, "grid.cells cannot change during a run: the layout of the state depends on it");
    expect({"liquid", "[]"}, "it is read only at the start");
    expect({"output.every", "0.1"}, "one series from start to end");
    expect({"fluid.density", "1"}, "cannot be converted");
    expect({"effects.xsph.c", "0.1"}, "effects.xsph is not named in this scene");
    expect({"effects.gravity.q", "1"}, "there is no such key; did you mean \"effects.gravity.g\"?");
    expect({"effects.gravity.g", "[0]"}, "with dim = 2 it must have 2");
    expect({"scheme.iterations", "0"}, "at least 1");
    expect({"scheme.iterations", "2.5"}, "an integer");
    EXPECT_EQ(state_of(simulation), before);
    EXPECT_EQ(simulation.scene().integer("scheme.iterations"), 2);
}

TEST("changes in a file are refused where they stand: a key that cannot, a value that may not, an order that is none") {
    const auto said = refusal([] {
        parsed(cases()[3].scene + "changes = [\n" + change(0.2, "grid.cells", "[8, 8]") + ",\n" + change(0.1, "scheme.iterations", "0") +
               ",\n" + change(0.3, "time.max_dt", "true") + "\n]\n");
    });
    for (const char* part :
         {"steered.toml:10:21", "the layout of the state depends on it", "steered.toml:11:10", "before the previous one at 0.2 s",
          "scheme.iterations", "steered.toml:11:50", "at least 1", "steered.toml:12:44", "time.max_dt"})
        EXPECT_NE(said.find(part), std::string::npos) << part << " in\n" << said;
}

TEST("a scene written from what it gives reads as the same scene: all that come with weir") {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(WEIR_SOURCE_DIR) + "/cases")) {
        const auto file = entry.path() / "scene.toml";
        if (!std::filesystem::exists(file)) continue;
        const auto scene = scene::read(file, sim::schemas());
        const auto again = parsed(scene::to_scene_text(scene.root()));
        EXPECT_EQ(scene::to_toml(scene.root()).size(), scene::to_toml(again.root()).size()) << file;
        for (const auto& key : scene.root().keys())
            EXPECT_EQ(scene::to_toml(*scene.root().find(key)).size(), scene::to_toml(*again.root().find(key)).size()) << file << " " << key;
        ++scenes;
    }
    EXPECT_GT(scenes, 50);
}

}  // namespace

}  // namespace steering_tests
