// Check after every step that all values are finite.
#pragma once
#include "core/solver.hpp"

namespace weir::sim {

/// Throws NumericalFailure naming the first quantity that is not finite: a field, or a number of the report.
void check_finite(const FieldSet& fields, const StepReport& report);

}  // namespace weir::sim
