// Liquid that its own weight or its surface moves: how far a thick one spreads, how a drop swings.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// How much longer than high the liquid is, from where its middle stands.
Curve stretch(const RunRecord& run, const Reference& ref) {
    Curve c = run.series("front_x");
    const Curve top = run.series("top");
    for (std::size_t i = 0; i < c.size(); ++i) c.y[i] -= top.y[i] + ref.number("middle");
    c.label = "weir";
    return c;
}

/// Energy of motion at its largest after the first half period, over that before it.
real swing_gain(const RunRecord& run, const Reference& ref) {
    const Curve moves = run.series("kinetic_energy");
    real first = 0, later = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        real& largest = moves.x[i] < pi / ref.number("frequency") ? first : later;
        largest = std::max(largest, moves.y[i]);
    }
    return later / first - 1;
}

/// Mean relative error of the front over the last half of the run.
real spreading_error(const RunRecord& run, const Reference& ref) {
    const Curve front = run.series("front_x");
    real sum = 0, count = 0;
    for (std::size_t i = front.size() / 2; i < front.size(); ++i) {
        const real exact = ref.number("reach") * std::pow(front.x[i], 0.2);
        sum += std::abs(front.y[i] - ref.number("wall") - exact) / exact, count += 1;
    }
    return sum / count;
}

}  // namespace

std::vector<Metric> capillary_metrics() {
    return {
        {.name = "drop.frequency_error",
         .unit = "",
         .doc = "Relative error of the frequency at which a drop is longer than high, from zero crossings, to that of small swings.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return std::abs(frequency(stretch(run, ref)) / ref.number("frequency") - 1); },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Length less height", .x = {"t [s]"}, .y = {"[m]"}, .curves = {stretch(run, ref)}};
             }},
        {.name = "drop.swing_gain",
         .unit = "",
         .doc = "Energy of motion at its largest in any later half period over that in the first one, less 1.",
         .measure = swing_gain},
        {.name = "spreading.front_error",
         .unit = "",
         .doc = "Mean relative error of the front of a current over the last half of the run.",
         .measure = spreading_error,
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 Curve ours = run.series("front_x");
                 ours.label = "weir";
                 return Panel{.title = "Front", .x = {"t [s]"}, .y = {"x [m]"}, .curves = {ref.curve("front"), ours}};
             }},
    };
}

}  // namespace weir::validation
