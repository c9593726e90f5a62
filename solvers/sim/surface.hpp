// Position of the free surface: from the solver's heights, from its level set (both linear between cell centres), or from its particles
// (particle_surface.hpp).
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

#include <array>
#include <functional>

namespace weir::sim {

bool has_surface(const FieldSet& fields);
/// The highest liquid on the line through x along `axis`, as a coordinate [m]; the lower end where the line is dry.
real highest_liquid(const FieldSet& fields, const Vec<3>& x, int axis);
/// Length of the line through x along `axis` inside liquid [m]; a drop in the air counts only by itself.
real liquid_depth(const FieldSet& fields, const Vec<3>& x, int axis);
/// Distance from a point to the nearest solid [m].
using Room = std::function<real(const Vec<3>& x)>;
/// The highest coordinate along `axis` of any liquid [m]; the lower end of the domain where there is none. A particle extends half a
/// spacing beyond its centre, but not into walls, nor into solids where `room` is given.
real front(const FieldSet& fields, int axis, const Room& room = {});

}  // namespace weir::sim
