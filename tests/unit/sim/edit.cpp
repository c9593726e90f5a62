// Edits of a run between two steps: what is written is checked and made good, what comes and goes is counted, who looks on is called.
#include "parallel/communicator.hpp"
#include "shared/device.hpp"
#include "sim/registry.hpp"
#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>
#include <iterator>
#include <numeric>

namespace edit_tests {

namespace {

using namespace weir;
using scene::Builder;
using test::fake_simulation;

Builder square(const std::string& solver, int cells) {
    const real n = cells;
    return Builder()
        .set("solver", solver)
        .set("dim", std::int64_t{2})
        .set("grid.cells", {n, n})
        .set("grid.size", {1, 1})
        .set("time.end", 0.2);
}
Simulation made(const Builder& scene) { return Simulation(scene.scene(sim::schemas())); }

/// A drop in the middle of a box without gravity, which nothing moves.
Builder drop(const std::string& solver, int cells = 32) {
    return square(solver, cells).add("liquid", Builder().set("shape", "sphere").set("centre", {0.5, 0.5}).set("radius", 0.2));
}

std::string state_of(const Simulation& simulation) {
    test::TemporaryFolder folder;
    Checkpoint state;
    simulation.solver().save(state);
    state.write(folder.path() / "a");
    std::ifstream file(folder.path() / "a", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
real integral(const Simulation& simulation, const std::string& name) {
    for (const auto& one : simulation.solver().integrals())
        if (one.name == name) return one.value;
    throw std::logic_error("no integral " + name);
}
real mean(std::span<const real> values) { return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<real>(values.size()); }
std::span<const real> component(const FieldSet& fields, std::string_view set, std::string_view name, std::size_t axis) {
    return fields.find(set, name)->data.at(axis);
}
void fill(FieldEdit& field, std::initializer_list<real> values) {
    std::size_t c = 0;
    for (const real value : values) field.data.at(c).assign(field.data.at(c).size(), value), ++c;
}
std::string refusal(const std::function<void()>& what) {
    try {
        what();
    } catch (const BadInput& error) {
        return error.what();
    }
    return "nothing was refused";
}

void expect_in(const std::string& text, const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << text; }

/// div u at the cells of a square grid, from its faces, x fastest [1/s].
std::vector<real> divergence(const std::vector<std::span<const real>>& u, int n, real h) {
    std::vector<real> div;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto x = static_cast<std::size_t>(j * (n + 1) + i), y = static_cast<std::size_t>(j * n + i);
            div.push_back((u[0][x + 1] - u[0][x] + u[1][y + static_cast<std::size_t>(n)] - u[1][y]) / h);
        }
    return div;
}
real l2(const std::vector<real>& values) { return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0)); }

TEST("a velocity that is written into smoke comes out free of divergence and at rest at walls; the pressure stays") {
    constexpr int n = 16;
    Simulation simulation = made(square("mac", n).set("initial.velocity.name", "random").set("initial.velocity.speed", 1.0));
    simulation.step();
    const auto shown = simulation.fields();
    const std::vector<real> pressure(shown.find("pressure")->data[0].begin(), shown.find("pressure")->data[0].end());
    real before = 0;
    simulation.edit("velocity", [&](FieldEdit& u) {
        EXPECT_EQ(u.unit, "m/s");
        EXPECT_EQ(u.where, Where::face);
        for (std::size_t i = 0; i < u.data[0].size(); ++i) u.data[0][i] = std::sin(static_cast<real>(7 * i));  // on walls too
        std::vector<std::span<const real>> held{u.data[0], u.data[1]};
        std::vector<real> at_rest = u.data[0];  // what the walls make of it
        for (std::size_t j = 0; j < n; ++j) at_rest[j * (n + 1)] = at_rest[j * (n + 1) + n] = 0;
        held[0] = at_rest;
        before = l2(divergence(held, n, 1.0 / n));
    });
    const auto fields = simulation.fields();
    // ||div u|| of what is left is at most the solver's tolerance of what there was: it is the residual, in the same norm
    EXPECT_LE(l2(divergence(fields.find("velocity")->data, n, 1.0 / n)), simulation.scene().number("scheme.poisson.tolerance") * before);
    for (std::size_t j = 0; j < n; ++j) EXPECT_EQ(component(fields, "", "velocity", 0)[j * (n + 1)], 0);
    EXPECT_TRUE(std::equal(pressure.begin(), pressure.end(), fields.find("pressure")->data[0].begin()));
    EXPECT_GT(before, 1);
    simulation.step();
}

TEST("smoke is as it was written, but where a source holds it and inside solids, where there is none") {
    Simulation simulation =
        made(square("mac", 16)
                 .add("emitters", Builder().set("shape", "box").set("min", {0, 0}).set("max", {0.25, 0.25}).set("smoke", 1.0))
                 .add("solids", Builder().set("shape", "box").set("min", {0.5, 0.5}).set("max", {0.75, 0.75})));
    simulation.edit("smoke", [](FieldEdit& smoke) { fill(smoke, {0.5}); });
    const auto smoke = simulation.fields().find("smoke")->data[0];
    EXPECT_EQ(smoke[0], 1);
    EXPECT_EQ(smoke[4 * 16 + 12], 0.5);
    EXPECT_EQ(smoke[10 * 16 + 10], 0);
}

TEST("in parallel edits are refused by name before anything is touched, and nothing is editable") {
    Simulation water = made(drop("mac_water")), particles = made(drop("pbf"));
    const std::string before = state_of(water), before_particles = state_of(particles);
    const std::vector<Vec<3>> at{{{0.5, 0.5, 0}}};
    const std::vector<std::size_t> which{0};
    {
        set_communicator(std::make_unique<Communicator>(0, 2));
        const std::unique_ptr<void, void (*)(void*)> alone_again(&water, [](void*) { set_communicator(nullptr); });
        bool written = false;
        expect_in(refusal([&] { water.edit("velocity", [&](FieldEdit&) { written = true; }); }),
                  "\"velocity\" is edited in one process only, and the number of ranks is 2");
        expect_in(refusal([&] { water.add_particles("markers", at, at); }),
                  "particles of the set \"markers\" are added in one process only");
        expect_in(refusal([&] { particles.remove_particles("particles", which); }), "are removed in one process only");
        EXPECT_FALSE(written);
        EXPECT_TRUE(water.editable().empty());
    }
    EXPECT_EQ(state_of(water), before);
    EXPECT_EQ(state_of(particles), before_particles);
    EXPECT_FALSE(water.editable().empty());
}

TEST("what cannot be written is refused, and not a bit changes") {
    Simulation simulation = made(drop("mac_water"));
    simulation.step();
    const std::string before = state_of(simulation);
    expect_in(refusal([&] { simulation.edit("velocity", [](FieldEdit& u) { u.data[1][3] = std::nan(""); }); }), "not finite at 3");
    expect_in(refusal([&] { simulation.edit("velocity", [](FieldEdit& u) { u.data[0].pop_back(); }); }), "has 1056 values");
    expect_in(refusal([&] { simulation.edit("velocity", [](FieldEdit& u) { u.data.pop_back(); }); }), "2 components, not 1");
    expect_in(refusal([&] { simulation.edit("pressure", [](FieldEdit&) {}); }),
              "no field \"pressure\" that may be edited in this scene; known: velocity");
    const std::vector<Vec<3>> outside{{{0.5, 1.5, 0}}}, deep{{{0.5, 0.5, 0.5}}}, still{{{0, 0, 0}}};
    expect_in(refusal([&] { simulation.add_particles("markers", outside, still); }), "particle 0 has y = 1.5; the domain is [0, 1]");
    expect_in(refusal([&] { simulation.add_particles("markers", deep, still); }), "z = 0.5 in a scene of two dimensions");
    expect_in(refusal([&] { simulation.add_particles("particles", still, still); }),
              "does not support adding particles of a set \"particles\"");
    const std::vector<std::size_t> far{100000};
    expect_in(refusal([&] { simulation.remove_particles("markers", far); }), "there is no particle 100000");
    EXPECT_EQ(state_of(simulation), before);
    Simulation waves = made(square("waves", 16)
                                .set("effects.gravity.g", {0, -9.81})
                                .set("waves.model", "sines")
                                .add("waves.trains", Builder().set("amplitude", 0.01).set("wavelength", 0.5)));
    expect_in(refusal([&] { waves.edit("velocity", [](FieldEdit&) {}); }), "it has none");
}

/// Of the cells of a square grid that are liquid all around.
real deep_divergence(const FieldSet& fields, int n, real h) {
    const std::vector<real> div = divergence(fields.find("velocity")->data, n, h);
    const auto phi = component(fields, "", "level_set", 0);
    real sum = 0;
    for (std::size_t c = 0; c < div.size(); ++c) sum += phi[c] < -1.5 * h ? div[c] * div[c] : 0;
    return std::sqrt(sum);
}

TEST("a velocity that is written into tall cells becomes one that they can have, free of divergence") {
    constexpr int n = 32;
    Simulation simulation = made(square("tallcell", n)
                                     .set("effects.gravity.g", {0, -9.81})
                                     .add("liquid", Builder().set("shape", "box").set("min", {0, 0}).set("max", {1, 0.75})));
    simulation.step();
    ASSERT_EQ(simulation.editable(), (std::vector<std::string>{"velocity"}));
    ASSERT_GT(component(simulation.fields(), "", "cell_height", 0)[0], 1.5 / n);  // there are tall cells
    real before = 0;
    simulation.edit("velocity", [&](FieldEdit& u) {
        for (std::size_t i = 0; i < u.data[0].size(); ++i) u.data[0][i] = std::sin(static_cast<real>(7 * i));
        before = l2(divergence({u.data[0], u.data[1]}, n, 1.0 / n));
    });
    // the residual of the unknowns, in the same norm; a column that stands for eight rows has their sum
    const real tolerance = simulation.scene().number("scheme.poisson.tolerance");
    EXPECT_LE(deep_divergence(simulation.fields(), n, 1.0 / n), 8 * tolerance * before);
    EXPECT_GT(before, 1);
    real energy = integral(simulation, "kinetic_energy");
    EXPECT_GT(energy, 1e-3);
    simulation.edit("velocity", [](FieldEdit&) {});  // it is such a velocity already: a projection is idempotent
    EXPECT_NEAR(integral(simulation, "kinetic_energy"), energy, 2 * tolerance * before / n * energy);
    simulation.edit("velocity", [](FieldEdit& u) { fill(u, {0, 0}); });
    EXPECT_LE(integral(simulation, "kinetic_energy"), 1e-15);  // at the time of the fields: a rate of 1e-9 of g is left of the pressure
    simulation.step();
}

TEST("a drop that is given a velocity flies with it, markers and all, whatever carries its momentum") {
    for (const char* transfer : {"grid", "pic", "flip", "apic"}) {
        Simulation simulation = made(drop("mac_water").set("scheme.transfer", transfer).set("scheme.reseed", false).set("time.dt", 0.005));
        simulation.edit("velocity", [](FieldEdit& u) { fill(u, {1, 0.5}); });
        const auto at = [&](std::size_t axis) { return mean(component(simulation.fields(), "markers", "position", axis)); };
        const real x = at(0), y = at(1);
        for (int i = 0; i < 4; ++i) simulation.step();
        // A uniform velocity has no divergence and meets no wall: nothing acts on it but rounding and the solver, whose answer is exact.
        EXPECT_NEAR(at(0) - x, 0.02, 1e-12) << transfer;
        EXPECT_NEAR(at(1) - y, 0.01, 1e-12) << transfer;
    }
}

TEST("markers that come bring liquid with their velocity, and are counted; those that go take theirs along") {
    for (const char* transfer : {"grid", "flip", "apic"}) {
        Simulation simulation = made(drop("mac_water").set("scheme.transfer", transfer).set("time.dt", 0.002));
        const real volume = integral(simulation, "volume"), balance = integral(simulation, "volume_target");
        std::vector<Vec<3>> at, velocity;
        const real h = 1.0 / 32;  // four cells each way, full: four markers a cell
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                at.push_back({{4 * h + (i + 0.5) * h / 2, 24 * h + (j + 0.5) * h / 2, 0}}), velocity.push_back({{0, -1, 0}});
        simulation.add_particles("markers", at, velocity);
        EXPECT_NEAR(integral(simulation, "volume_target"), balance + 16 * h * h, 1e-14);
        const real more = integral(simulation, "volume") - volume;  // within half a cell all around of what they stand for
        EXPECT_GT(more, 9 * h * h) << transfer;
        EXPECT_LT(more, 25 * h * h) << transfer;
        const auto v = component(simulation.fields(), "", "velocity", 1);
        EXPECT_NEAR(v[26 * 32 + 6], -1, 1e-9) << transfer;  // it falls freely in air; the drop beside it rests
        EXPECT_NEAR(v[16 * 32 + 16], 0, 1e-9) << transfer;
        const auto y = [&] { return component(simulation.fields(), "markers", "position", 1); };
        real highest = *std::max_element(y().begin(), y().end());
        simulation.step();
        EXPECT_NEAR(highest - *std::max_element(y().begin(), y().end()), 0.002, 1e-9) << transfer;
        std::vector<std::size_t> upper;
        for (std::size_t p = 0; p < y().size(); ++p)
            if (y()[p] > 0.72) upper.push_back(p);
        EXPECT_EQ(upper.size(), 64u);
        simulation.remove_particles("markers", upper);
        EXPECT_LT(*std::max_element(y().begin(), y().end()), 0.72);
        EXPECT_NEAR(integral(simulation, "volume"), volume, 2 * h * h) << transfer;
        for (int i = 0; i < 5; ++i) simulation.step();
    }
}

/// A solver and, where it has several, a backend.
using Runs = std::vector<std::pair<const char*, const char*>>;
const Runs on_device{{"pbf", "opencl"}, {"sph", "opencl"}};

void move_push_add_and_take_out(const Runs& runs) {
    for (const auto& [solver, backend] : runs) {
        Simulation simulation = made(drop(solver, 20).set("scheme.backend", backend));
        simulation.step();
        const auto count = [&] { return component(simulation.fields(), "particles", "id", 0).size(); };
        const std::size_t before = count();
        const real mass = integral(simulation, "mass");
        EXPECT_EQ(simulation.editable(), (std::vector<std::string>{"particles.position", "particles.velocity"}));
        simulation.edit("particles.position", [](FieldEdit& x) {
            for (real& value : x.data[0]) value += 0.1;
        });
        simulation.edit("velocity", [](FieldEdit& u) { fill(u, {0.25, 0}); });
        EXPECT_EQ(integral(simulation, "max_speed"), 0.25);
        expect_in(refusal([&] { simulation.edit("position", [](FieldEdit& x) { x.data[0][2] = 1.25; }); }), "it must lie in [0, 1]");
        const std::vector<Vec<3>> at{{{0.1, 0.1, 0}}, {{0.1, 0.9, 0}}}, velocity{{{0, 0, 0}}, {{0, 0, 0}}};
        simulation.add_particles("particles", at, velocity);
        EXPECT_EQ(count(), before + 2);
        EXPECT_NEAR(integral(simulation, "mass"), mass * static_cast<real>(before + 2) / static_cast<real>(before), 1e-9 * mass);
        const std::vector<std::size_t> which{0, 5};
        const real id = component(simulation.fields(), "particles", "id", 0)[1];
        simulation.remove_particles("particles", which);
        EXPECT_EQ(count(), before);
        EXPECT_EQ(component(simulation.fields(), "particles", "id", 0)[0], id);
        for (int i = 0; i < 5; ++i) simulation.step();
    }
}

TEST("particles are moved, pushed, added and taken out; the walls hold") {
    move_push_add_and_take_out({{"pbf", "threads"}, {"sph", "threads"}, {"pbf", "reference"}});
}
TEST("particles on a device are moved, pushed, added and taken out; the walls hold") {
    if (const std::string why = test::missing_device(); !why.empty()) GTEST_SKIP() << why;
    move_push_add_and_take_out(on_device);
}

TEST("while a field is edited the simulation neither steps nor changes otherwise, and goes on after it") {
    Simulation simulation = made(drop("sph", 16));
    const std::string before = state_of(simulation);
    const std::vector<Vec<3>> at{{{0.1, 0.1, 0}}}, still{{{0, 0, 0}}};
    const std::vector<std::size_t> which{0};
    Checkpoint saved;
    simulation.save(saved);
    const std::vector<std::pair<std::string, std::function<void()>>> changes{
        {"steps", [&] { simulation.step(); }},
        {"steps", [&] { simulation.run_until(0.1); }},
        {"a key changes", [&] { simulation.set("time.end", 0.3); }},
        {"another field is edited", [&] { simulation.edit("velocity", [](FieldEdit&) {}); }},
        {"another field is edited", [&] { simulation.edit("position", [](FieldEdit&) {}); }},
        {"particles are added", [&] { simulation.add_particles("particles", at, still); }},
        {"particles are removed", [&] { simulation.remove_particles("particles", which); }},
        {"from a checkpoint", [&] { simulation.restore(saved); }},
    };
    for (const auto& one : changes) {
        const std::string told = refusal([&] {
            simulation.edit("velocity", [&](FieldEdit& u) {
                fill(u, {1, 0});
                one.second();
            });
        });
        expect_in(told, "\"particles.velocity\" is being edited");
        expect_in(told, one.first);
        EXPECT_EQ(state_of(simulation), before) << one.first;
    }
    EXPECT_EQ(simulation.steps(), 0);
    simulation.edit("velocity", [](FieldEdit& u) { fill(u, {0.25, 0}); });
    EXPECT_EQ(integral(simulation, "max_speed"), 0.25);
    simulation.step();
}

TEST("a depth that is raised keeps its velocity and is counted as poured") {
    Simulation simulation = made(square("heightfield", 16)
                                     .set("effects.gravity.g", {0, -9.81})
                                     .add("liquid", Builder().set("shape", "box").set("min", {0, 0}).set("max", {0.5, 0.5})));
    simulation.run_until(0.05);
    const real balance = integral(simulation, "volume_balance");
    const auto u = component(simulation.fields(), "", "velocity", 0);
    const std::vector<real> velocity(u.begin(), u.end());
    simulation.edit("depth", [](FieldEdit& depth) {
        for (real& value : depth.data[0]) value *= 2;
    });
    const auto now = component(simulation.fields(), "", "velocity", 0);
    for (std::size_t i = 0; i < velocity.size(); ++i) EXPECT_NEAR(now[i], velocity[i], 1e-14 * (1 + std::abs(velocity[i])));
    EXPECT_NEAR(integral(simulation, "volume_balance"), balance, 1e-15);
    expect_in(refusal([&] { simulation.edit("depth", [](FieldEdit& depth) { depth.data[0][1] = -1; }); }), "must lie in [0, inf]");
    expect_in(refusal([&] { simulation.edit("velocity", [](FieldEdit& w) { w.data[1][1] = 1; }); }), "must lie in [0, 0]");
    simulation.run_until(0.1);
}

TEST("columns that are raised are counted as poured, and neither run dry nor wet dry ground") {
    Simulation simulation = made(square("heightfield", 16)
                                     .set("scheme.model", "columns")
                                     .set("effects.gravity.g", {0, -9.81})
                                     .add("liquid", Builder().set("shape", "box").set("min", {0, 0}).set("max", {0.5, 0.5})));
    simulation.run_until(0.05);
    const real balance = integral(simulation, "volume_balance"), volume = integral(simulation, "volume");
    simulation.edit("surface", [](FieldEdit& surface) { surface.data[0][3] += 0.16; });
    EXPECT_NEAR(integral(simulation, "volume"), volume + 0.01, 1e-15);
    EXPECT_NEAR(integral(simulation, "volume_balance"), balance, 1e-15);
    expect_in(refusal([&] { simulation.edit("surface", [](FieldEdit& surface) { surface.data[0][2] = -0.1; }); }),
              "does not support drying");
    expect_in(refusal([&] { simulation.edit("surface", [](FieldEdit& surface) { surface.data[0][12] = 0.1; }); }),
              "does not support wetting");
    expect_in(refusal([&] { simulation.edit("velocity", [](FieldEdit& u) { u.data[0][2] = 1; }); }), "must lie in [0, 0]");
    simulation.edit("velocity", [](FieldEdit& u) { u.data[1][1] = -0.1; });
    simulation.run_until(0.1);
}

void go_on_from_an_edit(const Runs& runs) {
    for (const auto& [solver, backend] : runs) {
        Builder scene = drop(solver, 20);
        if (*backend) scene.set("scheme.backend", backend);
        if (std::string(solver) == "tallcell") scene.set("effects.gravity.g", {0, -9.81});
        Simulation simulation = made(scene);
        simulation.step();
        simulation.edit("velocity", [](FieldEdit& u) { fill(u, {1, 0.5}); });
        Checkpoint checkpoint;
        simulation.save(checkpoint);
        Simulation again(scene_of(checkpoint));
        again.restore(checkpoint);
        for (int i = 0; i < 3; ++i) simulation.step(), again.step();
        EXPECT_EQ(state_of(simulation), state_of(again)) << solver;
    }
}

TEST("from a checkpoint that was made after an edit the run goes on bit for bit") {
    go_on_from_an_edit({{"mac_water", ""}, {"tallcell", ""}, {"pbf", "threads"}, {"sph", "threads"}});
}
TEST("from a checkpoint that was made after an edit the run goes on bit for bit on a device") {
    if (const std::string why = test::missing_device(); !why.empty()) GTEST_SKIP() << why;
    go_on_from_an_edit(on_device);
}

TEST("observers are called at frames and every so many steps, may steer, and what they throw comes out of the step") {
    auto simulation = fake_simulation("time = { end = 1.0, dt = 0.1 }\noutput = { every = 0.25, at = \"exact\" }\n");
    std::vector<real> frames;
    std::vector<std::int64_t> steps;
    simulation.observe_frames([&](Simulation& s, const StepReport& report) {
        EXPECT_GT(report.dt, 0);
        frames.push_back(s.time());
        if (frames.size() == 2) s.set("time.dt", 0.05);
    });
    simulation.observe_steps([&](Simulation& s, const StepReport&) { steps.push_back(s.steps()); }, 3);
    while (!simulation.finished()) simulation.step();
    ASSERT_EQ(frames.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(frames[i], 0.25 * static_cast<real>(i + 1), 1e-12);
    ASSERT_GE(steps.size(), 4u);
    for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i], 3 * static_cast<std::int64_t>(i + 1));
    auto stopped = fake_simulation("time = { end = 1.0 }\n");
    stopped.observe_steps([](Simulation& s, const StepReport&) {
        if (s.steps() == 2) throw std::runtime_error("enough");
    });
    EXPECT_THROW(stopped.run_until(1), std::runtime_error);
    EXPECT_EQ(stopped.steps(), 2);
    expect_in(refusal([&] { stopped.observe_steps({}, 0); }), "at least 1");
}

TEST("a column of a probe by its name, with or without the unit") {
    Simulation simulation = made(
        drop("mac_water").add("probes", Builder().set("name", "p").set("kind", "point").set("at", {0.5, 0.5}).set("field", "velocity")));
    simulation.step();
    const ProbeSeries& series = simulation.probe_series("p");
    EXPECT_EQ(series.column("velocity_y").size(), series.times.size());
    EXPECT_EQ(series.column("velocity_y [m/s]"), series.column("velocity_y"));
    expect_in(refusal([&] { series.column("velocity_w"); }), "no column \"velocity_w\"; it has velocity_x [m/s], velocity_y [m/s]");
}

TEST("a scene made in code is the scene of its text, and refused as that is") {
    Builder scene = drop("mac_water").set("time.end", 1.0).name("effects.volume_control");
    scene.add("liquid", Builder().set("shape", "box").set("min", {0, 0}).set("max", {1, 0.1}));
    const scene::Scene read = scene::parse(scene.text(), "scene", sim::schemas());
    EXPECT_EQ(scene::to_toml(scene.scene(sim::schemas()).root()), scene::to_toml(read.root()));
    EXPECT_EQ(read.root().tables("liquid").size(), 2u);
    EXPECT_EQ(read.number("time.end"), 1);
    scene.set("grid.cells", {32, -16}).set("time.end", "soon").name("effects.gravitation");
    const std::string said = refusal([&] { scene.scene(sim::schemas()); });
    EXPECT_EQ(said, refusal([&] { scene::parse(scene.text(), "scene", sim::schemas()); }));
    expect_in(said, "3 problems");
    expect_in(said, "scene:3:19: ");
}

}  // namespace

}  // namespace edit_tests
