// Rejects bodies that start inside each other, inside solids or through walls of the domain: contacts would separate them within a step or
// two, at very high speed. Touching, or overlap within the tolerance of contacts, is allowed.
#pragma once
#include "rigid/contacts.hpp"

#include <string>

namespace weir::rigid {

/// Penetration depth of a body, at its initial position, into a region [m]; 0 where they do not overlap. It is the depth of the deepest
/// contact sphere. Where none is inside (a thin plate through the middle of a box), it is the diameter of the largest ball inside both,
/// searched from a lattice over the body.
template <int D>
real depth_in(const Body<D>& body, const Bounds<D>& box, const geometry::Shape<D>& other);

/// Throws BadScene where a movable body overlaps a wall, a solid at t = 0 or another body without a joint between them.
template <int D>
void refuse_overlaps(const scene::Scene& scene, const std::vector<Body<D>>& bodies, const Joints<D>& joints, const Surroundings<D>& around);

}  // namespace weir::rigid
