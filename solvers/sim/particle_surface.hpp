// The free surface of particles on a line along an axis: where the density of their volumes falls to half of its value below.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

namespace weir::sim {

/// The highest coordinate along `axis` that particles reach on the line through x along that axis [m]; the lower end of the domain where
/// none is near the line.
real highest_of_particles(const FieldSet& fields, const Vec<3>& x, int axis);

/// Length of the line inside the particles' liquid [m].
real depth_of_particles(const FieldSet& fields, const Vec<3>& x, int axis);

}  // namespace weir::sim
