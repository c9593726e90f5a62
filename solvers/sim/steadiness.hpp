// How far a flow is from steady: max |u(t + dt) - u(t)| over the velocity on the grid (time.stop_when_steady).
#pragma once
#include "core/solver.hpp"

#include <vector>

namespace weir::sim {

/// A copy, one list a component; over ranks that hold their own planes alone, of those.
std::vector<std::vector<real>> grid_velocity(const FieldSet& fields);
/// The largest change anywhere since `before`, which is the velocity of `fields` from here on.
real change_and_keep(const FieldSet& fields, std::vector<std::vector<real>>& before);

}  // namespace weir::sim
