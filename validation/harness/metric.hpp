// Metrics: one number out of a finished run, by name. The generic ones (harness/generic_metrics.cpp) need no registration:
//   <field>.l1 .l2 .linf         mean, root mean square and largest |field - reference| at the end; at faces, cell centres or particles
//   <field>.l1_relative ...      the same over that norm of the reference
//   <field>.max                  largest |field| at the end; needs no reference
//   divergence.max               largest max_divergence of any step
//   <series>                     last value of an integral, an observed metric, a step report (dt, cfl, iterations, residual, ...)
//                                or a probe: probe.NAME is its first column, probe.NAME.velocity_x the one of that name
//   <series>.max .min .mean      over the run
//   <series>.drift               largest |value - first| / |first| over the run
//   <series>.change              (last - first) / |first|
//   <series>.end .rms .range .time_of_max .time_of_min .time_of(>LEVEL) .period, and any statistic with a window (@2.5, @0.8.., @0.8..2):
//                                quantities as weir plan names them (harness/named_quantity.hpp). Without a window mean is over the rows,
//                                with one it is over time
//   steps, seconds, ns_per_cell_step
// Metrics of one kind of case live in validation/metrics/ and are listed in metrics/registry.cpp.
#pragma once
#include "validation/harness/reference.hpp"
#include "validation/harness/run_record.hpp"

#include <functional>
#include <string>
#include <vector>

namespace weir::validation {

/// What the number is, for the order table: an error tends to zero; a value tends to something (Richardson finds out what).
enum class Quantity { error, value };

struct Metric {
    std::string name;  // "front.mean_error"
    std::string unit;  // "m", "1/s"; empty: none
    std::string doc;   // one sentence: what is computed
    Quantity quantity = Quantity::error;
    std::function<real(const RunRecord&, const Reference&)> measure;
    /// Optional: what to draw of this run (ours as lines, the reference's as points). Panels of equal title share one diagram,
    /// and the harness adds the variant and size to the labels of our curves.
    std::function<Panel(const RunRecord&, const Reference&)> figure = nullptr;
    /// Optional: called at the initial state and after every step; its values become run.series(name).
    std::function<real(const FieldSet&, const scene::Scene&, real t)> observe = nullptr;
};

/// Metrics by name beside the generic ones; defined in validation/metrics/registry.cpp.
const std::vector<Metric>& metrics();

}  // namespace weir::validation
