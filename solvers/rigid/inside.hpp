// Detects bodies that were pushed through a wall of the domain: a solid with prescribed motion does not yield, so contacts cannot hold a
// body between it and a wall.
#pragma once
#include "rigid/contacts.hpp"

namespace weir::rigid {

/// Throws NumericalFailure where the centroid of a body is beyond a wall by more than a tenth of the radius of its bounding ball, and the
/// velocities after contacts move its deepest point further out. Bodies may leave through open sides. Without the second condition, a body
/// that strikes a wall and turns by a large angle in the step would end the run: contacts are linear in a step, so it overlaps for a few
/// steps, in which they separate it.
template <int D>
void require_inside(const std::vector<Body<D>>& bodies, const Surroundings<D>& around);

}  // namespace weir::rigid
