// Budgets of fluid and bodies, on histories whose sums are known.
#include "parallel/partition.hpp"
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <cmath>

namespace body_budgets_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// A square box of 1 m full of fluid with a disc of a tenth of its area; each row of values: one moment.
RunRecord record(const std::vector<std::string>& names, const std::vector<std::vector<real>>& rows, const char* observer = "",
                 const std::vector<real>& observed = {}, const std::string& more = "") {
    const std::string text =
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [8, 8], size = [1.0, 1.0], origin = [0.0, 2.0] }\ntime = { end = 1.0 }\n"
        "fluid = { density = 1000.0 }\n"
        "bodies = [ { shape = \"box\", min = [0.4, 2.4], max = [0.6, 2.6], density = 500.0 } ]\n" +
        more;
    RunRecord run;
    run.scene = std::make_shared<const scene::Scene>(scene::parse(text, "box.toml", sim::schemas()));
    run.fields.grid = {.dim = 2, .cells = {8, 8, 1}, .origin = {0, 2, 0}, .spacing = {0.125, 0.125, 0}};
    for (const auto& name : names) run.integrals.push_back({name, "", 0});
    if (*observer) run.observers = {observer};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        Moment moment{.step = static_cast<std::int64_t>(i), .time = 0.1 * real(i), .integrals = rows[i]};
        if (*observer) moment.observed = {observed.at(i)};
        run.history.push_back(std::move(moment));
    }
    return run;
}

const std::vector<std::string> momenta{"momentum_x", "bodies_momentum_x", "bodies_momentum_y"};

std::string refusal(const std::string& metric, const RunRecord& run) {
    try {
        (void)measure(metric, run, {});
    } catch (const BadInput& bad) {
        return bad.what();
    }
    return "accepted";
}

const std::string down = "effects = { gravity = { g = [0.0, -9.81] } }\n";

}  // namespace

TEST("what the body loses the fluid or the walls have; what is missing is reported in parts of the body's momentum") {
    // 8 of the body's 10 go to the fluid, then 1 of the fluid's to a wall that is pushed with 10 N for 0.1 s
    const auto kept = record(momenta, {{0, 10, 0}, {8, 2, 0}, {7, 2, 0}}, "budget.momentum_x", {0, 0, 10});
    EXPECT_NEAR(measure("budget.momentum_x", kept, {}), 0, 1e-14);
    const auto lost = record(momenta, {{0, 10, 0}, {8, 2, 0}, {7, 2, 0}}, "budget.momentum_x", {0, 0, 0});
    EXPECT_NEAR(measure("budget.momentum_x", lost, {}), 0.1, 1e-14);
    const auto broken = record(momenta, {{0, 10, 0}, {std::nan(""), 2, 0}}, "budget.momentum_x", {0, 0});
    EXPECT_TRUE(std::isnan(measure("budget.momentum_x", broken, {})));
    EXPECT_NE(refusal("budget.momentum_x", record(momenta, {{0, 10, 0}}, "budget.momentum_x", {0}, down)).find("without gravity"),
              std::string::npos);
}

TEST("the force on walls is the pressure of the cells beside them") {
    FieldSet set;
    set.grid = {.dim = 2, .cells = {8, 4, 1}, .origin = {0, 0, 0}, .spacing = {0.125, 0.25, 0}};
    std::vector<real> p(32, 0);
    for (std::size_t y = 0; y < 4; ++y) p[8 * y] = 3, p[8 * y + 7] = 5;
    set.fields.push_back({"pressure", "Pa", Where::cell, "", {std::span<const real>(p)}});
    const auto run = record(momenta, {{0, 1, 0}});
    const Metric* x = find_metric("budget.momentum_x");
    const Metric* y = find_metric("budget.momentum_y");
    EXPECT_NEAR(x->observe(set, *run.scene, 0), 5 - 3, 1e-14);  // over one metre of height
    EXPECT_NEAR(y->observe(set, *run.scene, 0), 0, 1e-14);      // as much above as below
}

TEST("energy that a body has counts as the fluid's does, above the least that all had before") {
    const std::vector<std::string> names{"kinetic_energy", "potential_energy", "bodies_kinetic_energy", "bodies_potential_energy"};
    const real mass = 500 * 0.04, floor = mass * 9.81 * 2;  // bodies are counted from y = 0, the floor is at 2
    // 100 J of the fluid, 100 J of the body above the floor; the body's fall of 50 J becomes 30 J of the fluid, 20 J are lost, then 5 J
    // come back
    const auto run = record(names, {{0, 100, 0, floor + 100}, {0, 100, 50, floor + 50}, {30, 100, 0, floor + 50}, {25, 110, 0, floor + 50}},
                            "", {}, down);
    EXPECT_NEAR(measure("budget.energy_gain", run, {}), 5.0 / 200, 1e-12);
    EXPECT_NE(refusal("energy_gain", run).find("use budget.energy_gain for fluid and bodies"), std::string::npos);
}

TEST("water is counted where it is: above a body's flat bottom and below a flat surface, between the cells too") {
    const auto scene_of = [](const std::string& body) {
        return scene::parse(
            "solver = \"mac_water\"\ndim = 2\ngrid = { cells = [16, 16], size = [1.0, 1.0] }\ntime = { end = 1.0 }\n"
            "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = [0.0, 0.0], max = [1.0, 0.53] } ]\n" +
                down + "bodies = [ { " + body + ", density = 500.0 } ]\n",
            "tank.toml", sim::schemas());
    };
    const auto scene = scene_of("shape = \"box\", min = [0.25, 0.30], max = [0.75, 0.80]");
    const auto solver = sim::kind_named(scene.solver()).make(scene, {});
    const real energy = find_metric("budget.energy_gain")->observe(solver->fields(), scene, 0);
    const real exact = 9810 * (0.5 * 0.53 * 0.53 - 0.5 * 0.23 * 0.415);
    // an eighth of a cell in which the bottom or the surface is not told: half of it, h/16 of water at the surface's height along a metre
    EXPECT_NEAR(energy, exact, 9810 * 0.53 * (1.0 / 16 / 16));
    EXPECT_GT(std::abs(energy - 9810 * 0.5 * 0.53 * 0.53), 100) << "what the body displaces is not water";
}

}  // namespace body_budgets_tests
