// Kinetic energy of the whole flow, and the rate at which it is lost.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/samples.hpp"

#include <algorithm>

namespace weir::validation {
namespace {

/// -dE/dt at the middle of each step: viscosity's work and the scheme's together.
Curve dissipation(const Curve& energy) {
    Curve rate{.label = "weir", .x = {}, .y = {}};
    for (std::size_t i = 0; i + 1 < energy.size(); ++i) {
        rate.x.push_back((energy.x[i] + energy.x[i + 1]) / 2);
        rate.y.push_back(-(energy.y[i + 1] - energy.y[i]) / (energy.x[i + 1] - energy.x[i]));
    }
    return rate;
}

std::size_t peak(const Curve& c) {
    if (c.y.empty()) throw BadInput("no step was taken: there is no dissipation");
    return static_cast<std::size_t>(std::max_element(c.y.begin(), c.y.end()) - c.y.begin());
}

real observe_energy(const FieldSet& fields, const scene::Scene&, real) { return mean_kinetic_energy(fields); }

}  // namespace

std::vector<Metric> energy_metrics() {
    return {
        {.name = "flow.energy",
         .unit = "m^2/s^2",
         .doc = "Mean over the domain of |u|^2 / 2.",
         .quantity = Quantity::value,
         .measure = [](const RunRecord& run, const Reference&) { return run.series("flow.energy").y.back(); },
         .observe = observe_energy},
        {.name = "dissipation.peak_error",
         .unit = "",
         .doc = "Relative error of the largest rate at which kinetic energy is lost.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve rate = dissipation(run.series("dissipation.peak_error"));
                 return std::abs(rate.y[peak(rate)] / ref.number("peak_dissipation") - 1);
             },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Rate of energy loss",
                              .x = {"t [s]"},
                              .y = {"-dE/dt [m^2/s^3]"},
                              .curves = {ref.curve("dissipation"), dissipation(run.series("dissipation.peak_error"))}};
             },
         .observe = observe_energy},
        {.name = "dissipation.peak_time_error",
         .unit = "s",
         .doc = "Difference in time of the largest rate at which kinetic energy is lost.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve rate = dissipation(run.series("dissipation.peak_time_error"));
                 return std::abs(rate.x[peak(rate)] - ref.number("peak_time"));
             },
         .observe = observe_energy},
    };
}

}  // namespace weir::validation
