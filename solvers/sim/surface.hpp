// Where the free surface stands: from the solver's heights, from its level set (both linear between cell centres), or from its markers or
// particles where it has neither.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

#include <array>

namespace weir::sim {

bool has_surface(const FieldSet& fields);
/// The highest coordinate along `axis` that liquid reaches on the line through x along that axis [m]; the lower end where it is dry.
real highest_liquid(const FieldSet& fields, const Vec<3>& x, int axis);
/// How much of the line through x along that axis lies in liquid [m]: a drop in the air counts for itself alone.
real liquid_depth(const FieldSet& fields, const Vec<3>& x, int axis);
/// The highest coordinate along `axis` that liquid reaches anywhere [m]; the lower end of the domain where there is none.
real front(const FieldSet& fields, int axis);

}  // namespace weir::sim
