// What `weir cost --plan` says before a scene runs, against what the scene then does. For every solver of flows in its plain scene.
// Not covered: what a scene becomes later, and machines that are disturbed by more than a factor between two measurements of a second each.
#include "validation/cost/cost_estimate.hpp"

#include "core/parallel.hpp"
#include "sim/simulation.hpp"
#include "support/test.hpp"
#include "validation/cost/effect_scene.hpp"
#include "validation/cost/parallel_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation::cost_estimate_tests {
namespace {

scene::Scene scene_of(const scene::SolverKind& kind, int dim) { return plain_scene(kind, dim, dim == 2 ? 96 : 32); }

}  // namespace

TEST_IN_2D_AND_3D("memory of a scene that is small enough to be built is estimated to the byte, fields and effects among it") {
    for (const auto& kind : sim::registry()) {
        if (kind.schema.study) continue;
        const scene::Scene scene = scene_of(kind, D);
        const CostEstimate f = estimate_cost(scene);
        Simulation run(scene);
        double shown = 0;
        for (const auto& field : f.held.fields) shown += field.values * sizeof(real);
        EXPECT_LE(shown, f.held.bytes) << kind.schema.name << ": fields are part of what is held";
        run.step();
        EXPECT_EQ(f.held.bytes, static_cast<double>(run.solver().bytes())) << kind.schema.name;
    }
}

TEST("a scene of 500^3 cells is estimated without being built, its steps as a range") {
    const auto scene = scene::parse(
        "solver = \"mac\"\ndim = 3\ngrid = { cells = [499, 499, 499], size = [1.0, 1.0, 1.0] }\ntime = { end = 1.0 }\n"
        "initial.velocity = \"random\"\n",
        "scene.toml", sim::schemas());
    const CostEstimate f = estimate_cost(scene);
    EXPECT_FALSE(f.held.exact);
    EXPECT_GT(f.held.bytes, 80 * f.held.cells) << "what was once assumed";
    EXPECT_EQ(f.measured.size(), 2u) << "499 is a prime";
    EXPECT_GT(f.least_dt, 0);
    EXPECT_GE(f.most_dt, f.least_dt);
    const std::string text = cost_estimate_text(f, scene);
    EXPECT_NE(text.find(" steps, "), std::string::npos) << text;
    EXPECT_NE(text.find("from coarser copies of the scene"), std::string::npos) << text;
}

// The bar is 30 per cent. The estimate and the run are measured one after the other, three times, and the median of their ratio counts: a
// disturbance that is over within a second spoils one of them. Where that median is beyond the bar, six times more: the median of nine
// counts. Tall cells in 3D are held to a factor of 1.4 either way: a coarser copy has other columns, with fewer tall cells (1.15 to 1.22
// measured).
TEST_IN_2D_AND_3D("a step takes within 30 per cent of the estimated time") {
    set_threads(1);
    for (const auto& kind : sim::registry()) {
        if (kind.schema.study) continue;
        const scene::Scene scene = scene_of(kind, D);
        std::vector<double> ratios;
        const bool rough = D == 3 && kind.schema.name == "tallcell";
        const auto holds = [&](double ratio) { return rough ? std::abs(std::log2(ratio)) <= 0.5 : std::abs(ratio - 1) <= 0.3; };
        const auto median_of = [&](std::size_t rounds) {
            while (ratios.size() < rounds) {
                const double estimated = estimate_cost(scene).ms;
                ratios.push_back(estimated / measure_rates(scene, sim::registry(), 0.5).ms);
            }
            std::sort(ratios.begin(), ratios.end());
            return ratios[rounds / 2];
        };
        double ratio = median_of(3);
        if (!holds(ratio)) ratio = median_of(9);
        testing::Test::RecordProperty(std::string(kind.schema.name), std::to_string(ratio));
        EXPECT_TRUE(holds(ratio)) << kind.schema.name << ": estimated over measured, median of " << ratios.size() << ": " << ratio;
    }
}

TEST("passes are estimated by name, and together are the step") {
    const auto& kind = sim::kind_named("mac");
    const CostEstimate f = estimate_cost(scene_with(kind, 2, 48, {"buoyancy", "confinement"}, 0.1));
    double ms = 0;
    std::vector<std::string> names;
    for (const Pass& p : f.passes) ms += 1e3 * p.seconds, names.push_back(p.name);
    EXPECT_NEAR(ms, f.ms, 1e-9 * f.ms);
    for (const char* name : {"effect buoyancy", "effect confinement", "advect fields", "advect velocity", "project"})
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
    EXPECT_EQ(f.measured.size(), 2u);
}

TEST("messages of a large scene are counted on a copy, and bytes between neighbours are those of its planes") {
    const auto scene = scene::parse(
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [2560, 1920], size = [4.0, 3.0] }\ntime = { end = 1.0 }\ninitial.velocity = "
        "\"random\"\n",
        "scene.toml", sim::schemas());
    const CostEstimate f = estimate_cost(scene);
    ASSERT_GT(f.held.cells, 4 * most_cells_tried);
    const ParallelEstimate o = estimate_in_parallel(scene, f, 2, Link{1e-6, 1e10, "given"});
    EXPECT_NE(o.tried, "");
    EXPECT_NE(parallel_estimate_text(o, f, scene).find("a copy with " + o.tried + " cells"), std::string::npos);
    // Planes have sqrt(4.9) = 2.2 times the cells of the copy's. The copy has one level less, and each level has half the bytes of the
    // finer.
    const CountedSteps whole = count_messages(scene, 2, 1, 1);
    const auto bytes_per_iteration = [](const RankTraffic& sent, double iterations) {
        return static_cast<double>(sent.beside.bytes) / iterations;
    };
    EXPECT_NEAR(bytes_per_iteration(o.sent[0], o.iterations) / bytes_per_iteration(whole.sent[0], whole.iterations), 1, 0.25);
}

}  // namespace weir::validation::cost_estimate_tests
