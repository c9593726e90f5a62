// Gauges of one scene run by several solvers.
#include "validation/metrics/lists.hpp"

#include <cmath>

namespace weir::validation {
namespace {

/// Root mean square over the run of what two gauges differ by from the reference's, over the heap's height.
real gauge_error(const RunRecord& run, const Reference& ref) {
    real sum = 0;
    std::size_t count = 0;
    for (const char* name : {"near", "far"}) {
        const Curve ours = column(run.probe(name), 0), exact = ref.curve(name);
        for (std::size_t i = 0; i < ours.size(); ++i) {
            const real there = interpolate(exact, ours.x[i]);
            if (std::isnan(there)) continue;  // beyond the reference's last sample
            sum += (ours.y[i] - there) * (ours.y[i] - there), ++count;
        }
    }
    return std::sqrt(sum / static_cast<real>(count)) / ref.number("heap");
}

Panel gauge_panel(const RunRecord& run, const Reference& ref) {
    Curve ours = column(run.probe("far"), 0), exact = ref.curve("far");
    ours.label = "weir";
    exact.dashed = true;
    return {.title = "Height at the far gauge", .x = {"t [s]"}, .y = {"height [m]"}, .curves = {exact, ours}};
}

}  // namespace

std::vector<Metric> pond_metrics() {
    return {{.name = "pond.gauge_error",
             .unit = "",
             .doc = "Root mean square difference of two gauges' heights to the finest run's, over the height of the heap.",
             .measure = gauge_error,
             .figure = gauge_panel}};
}

}  // namespace weir::validation
