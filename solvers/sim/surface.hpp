// Where the free surface stands: from the solver's heights, from its level set (both linear between cell centres), or from its particles
// (particle_surface.hpp).
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

#include <array>
#include <functional>

namespace weir::sim {

bool has_surface(const FieldSet& fields);
/// The highest coordinate along `axis` that liquid reaches on the line through x along that axis [m]; the lower end where it is dry.
real highest_liquid(const FieldSet& fields, const Vec<3>& x, int axis);
/// How much of the line through x along that axis lies in liquid [m]: a drop in the air counts for itself alone.
real liquid_depth(const FieldSet& fields, const Vec<3>& x, int axis);
/// How far a place is from the nearest solid [m].
using Room = std::function<real(const Vec<3>& x)>;
/// The highest coordinate along `axis` that liquid reaches anywhere [m]; the lower end of the domain where there is none. A particle
/// reaches half a spacing beyond its centre, but not into walls, nor into solids where `room` tells of them.
real front(const FieldSet& fields, int axis, const Room& room = {});

}  // namespace weir::sim
