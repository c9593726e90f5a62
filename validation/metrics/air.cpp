// Enclosed air against references/air.cpp.
#include "validation/metrics/lists.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Length of the gas in a shaft: its volume over that of a metre.
Curve gas_length(const RunRecord& run, const Reference& ref) {
    Curve c = run.series("largest_pocket_volume");
    const real scale = ref.number("length") / c.y.front();
    for (real& y : c.y) y *= scale;
    c.label = "weir";
    return c;
}

std::size_t turn(const Curve& length) {
    return static_cast<std::size_t>(std::min_element(length.y.begin(), length.y.end()) - length.y.begin());
}

real turn_error(const RunRecord& run, const Reference& ref) {
    const Curve length = gas_length(run, ref);
    return std::abs(length.y[turn(length)] / ref.number("least") - 1);
}

real time_error(const RunRecord& run, const Reference& ref) {
    const Curve length = gas_length(run, ref);
    return std::abs(length.x[turn(length)] / ref.number("time") - 1);
}

real pressure_error(const RunRecord& run, const Reference& ref) {
    const Curve p = run.series("largest_pocket_pressure");
    return std::abs(*std::max_element(p.y.begin(), p.y.end()) / ref.number("pressure") - 1);
}

/// Mean over the second half of the run, in which the water swings about its rest.
real glass_error(const RunRecord& run, const Reference& ref) {
    const Curve volume = run.series("largest_pocket_volume");
    real sum = 0, count = 0;
    for (std::size_t i = volume.size() / 2; i < volume.size(); ++i) sum += volume.y[i], count += 1;
    return std::abs(sum / count / ref.number("volume") - 1);
}

/// From the time at which the rim closes the air to the end of the run.
real volume_lost(const RunRecord& run, const Reference&) {
    const Curve volume = run.series("largest_pocket_volume");
    const auto first = std::find_if(volume.y.begin(), volume.y.end(), [](real y) { return y > 0; });
    return first == volume.y.end() ? 1 : std::abs(volume.y.back() / *first - 1);
}

}  // namespace

std::vector<Metric> air_metrics() {
    return {
        {.name = "piston.turn_error",
         .unit = "",
         .doc = "Relative error of the least length of a gas cushion under a column of water.",
         .measure = turn_error,
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Gas cushion", .x = {"t [s]"}, .y = {"x [m]"}, .curves = {ref.curve("gas"), gas_length(run, ref)}};
             }},
        {.name = "piston.time_error",
         .unit = "",
         .doc = "Relative error of the time at which a gas cushion is shortest.",
         .measure = time_error},
        {.name = "piston.pressure_error",
         .unit = "",
         .doc = "Relative error of the largest absolute pressure of a gas cushion.",
         .measure = pressure_error},
        {.name = "glass.volume_error",
         .unit = "",
         .doc = "Relative error of the mean volume of the largest pocket of air over the last half of the run, to that at rest.",
         .measure = glass_error},
        {.name = "glass.volume_lost",
         .unit = "",
         .doc = "Relative change of the volume of the largest pocket of air from the time at which it was enclosed to the end.",
         .measure = volume_lost},
    };
}

}  // namespace weir::validation
