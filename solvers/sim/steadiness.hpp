// Deviation of a flow from steady state: max |u(t + dt) - u(t)| over the velocity on the grid (time.stop_when_steady).
#pragma once
#include "core/solver.hpp"

#include <vector>

namespace weir::sim {

/// A copy, one list per component; with distributed storage, of this rank's planes.
std::vector<std::vector<real>> grid_velocity(const FieldSet& fields);
/// The largest change since `before`, which is then set to the velocity of `fields`.
real change_and_keep(const FieldSet& fields, std::vector<std::vector<real>>& before);

}  // namespace weir::sim
