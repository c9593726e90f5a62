// The metrics that need no registration (the list stands in metric.hpp): norms of fields against the reference, and statistics of series.
#pragma once
#include "validation/harness/metric.hpp"

#include <string>
#include <string_view>

namespace weir::validation {

enum class Norm { l1, l2, linf };

/// |field - reference| at the end of the run, and the same norm of the reference. Norms are means over the domain: l1 = <|e|>,
/// l2 = sqrt(<e^2>), summed over components, each taken where it lives; faces on the boundary count half.
struct FieldError {
    real error = 0;
    real scale = 0;
};
FieldError field_error(const RunRecord& run, const Reference& reference, std::string_view field, Norm norm);

/// The metric called `name`, registered or generic. Throws BadInput when there is none, or when the run or the reference lacks what
/// it needs.
real measure(std::string_view name, const RunRecord& run, const Reference& reference);
/// Its unit, from the metric, the field or the integral; empty where it has none.
std::string unit_of(std::string_view name, const RunRecord& run);
/// Whether the metric's exact value is 0.
Quantity quantity_of(std::string_view name);
/// The registered metric of that name, or nullptr.
const Metric* find_metric(std::string_view name);
/// Whether each of several ranks has to hold whole fields for it: a registered metric may look anywhere, the generic ones look at what a
/// rank owns.
bool looks_at_whole_fields(std::string_view name);
/// Throws BadInput when `name` cannot be measured on a run that starts as `start`: so a misspelt metric costs no run.
void check_metric(std::string_view name, const RunRecord& start, const Reference& reference);

}  // namespace weir::validation
