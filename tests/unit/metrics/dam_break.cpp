// A collapsing column against tables whose distance from it is known.
#include "support/test.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <cmath>

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
