// A collapsing column against tables whose distance from it is known.
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <cmath>

namespace dam_break_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// Front 2 and height 1 at all times, in tables of constant `front` and `height`.
real error_against(real front, real height, const char* metric, real end = 3) {
    RunRecord run;
    run.probes = {{.name = "front", .times = {0, end}, .values = {{2}, {2}}}, {.name = "height", .times = {0, end}, .values = {{1}, {1}}}};
    Reference ref;
    ref.numbers = {{"base", 1}, {"height", 1}, {"front_time", 1}, {"height_time", 1}, {"time_shift", 0}};
    ref.curves["front"] = {.x = {1, 2}, .y = {front, front}};
    ref.curves["height"] = {.x = {1, 2}, .y = {height, height}};
    return measure(metric, run, ref);
}

}  // namespace

TEST("the error of a collapse is the larger of front's and height's, and not a number where a run ends before the table") {
    EXPECT_NEAR(error_against(1.6, 0.9, "collapse.error"), 0.25, 1e-12);  // |2 - 1.6| / 1.6 > |1 - 0.9|
    EXPECT_NEAR(error_against(1.6, 0.5, "collapse.error"), 0.5, 1e-12);
    EXPECT_NEAR(error_against(1.6, 0.5, "front.mean_error"), 0.25, 1e-12);
    EXPECT_TRUE(std::isnan(error_against(1.6, 0.5, "collapse.error", 1.5)));
}

// A wedge on a dry floor, y < (2 - x) / 4: it is 1/16 deep, a sixteenth of a base of one, at x = 1.75, its tip is at 2. The level set is
// linear, and so is the depth between columns: exact. Every row of the table then has Z = 1.75 where the tip has 2.
TEST("the front of a depth is where a wedge is so deep, between the columns too, and not its tip") {
    const int n = 30, m = 20;  // cells of 0.1 m by 0.05 m: 1.75 lies on the edge between two columns
    const auto scene = scene::parse(
        "solver = \"mac_water\"\ndim = 2\ngrid = { cells = [30, 20], size = [3.0, 1.0] }\ntime = { end = 1.0 }\n"
        "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [1.0, 0.5] } ]\n",
        "wedge.toml", sim::schemas());
    std::vector<real> phi;
    for (int j = 0; j < m; ++j)
        for (int i = 0; i < n; ++i) phi.push_back(0.05 * (j + 0.5) - (2 - 0.1 * (i + 0.5)) / 4);
    RunRecord run;
    run.fields.grid = {.dim = 2, .cells = {n, m, 1}, .origin = {0, 0, 0}, .spacing = {0.1, 0.05, 0}};
    run.fields.fields = {{level_set_name, "m", Where::cell, "", {phi}}};
    const Metric* metric = find_metric("front.mean_at_depth");
    ASSERT_NE(metric, nullptr);
    const real seen = metric->observe(run.fields, scene, 0);
    EXPECT_NEAR(seen, 1.75, 1e-12);
    run.observers = {"front.mean_at_depth"};
    for (const int step : {0, 1}) run.history.push_back({.step = step, .time = 3.0 * step, .observed = {seen}});
    Reference ref;
    ref.numbers = {{"base", 1}, {"front_time", 1}, {"time_shift", 0}};
    ref.curves["front"] = {.x = {1, 2}, .y = {1.5, 2}};
    EXPECT_NEAR(measure("front.mean_at_depth", run, ref), 1.75, 1e-12);
}

TEST("two experiments are as far apart as their points, over the rows that both cover") {
    Reference ref;
    ref.curves["front"] = {.x = {0, 1, 2, 9}, .y = {1, 2, 3, 99}};
    ref.curves["front.other"] = {.x = {1, 2}, .y = {2.2, 3}};  // 10% and nothing off at two rows; the others lie outside
    EXPECT_NEAR(measure("experiments.distance", RunRecord{}, ref), 0.05, 1e-12);
}

}  // namespace dam_break_tests
