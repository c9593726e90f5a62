// Bodies that begin inside each other, inside solids or through walls of the domain: contacts would push them apart in a step or two, at
// any speed that takes, so they are refused before the run. What touches, or overlaps by less than contacts let be, is no overlap.
#pragma once
#include "rigid/contacts.hpp"

#include <string>

namespace weir::rigid {

/// How deep a body where the scene puts it is in a region [m], 0 where it is not: how far the deepest of its contact spheres is inside;
/// where none is (a thin plate through the middle of a box), the width of the largest ball that is in both, found from a lattice over the
/// body.
template <int D>
real depth_in(const Body<D>& body, const Bounds<D>& box, const geometry::Shape<D>& other);

/// Refuses the scene (BadScene) where a body that can move overlaps a wall, a solid at t = 0 or another body that no joint ties it to.
template <int D>
void refuse_overlaps(const scene::Scene& scene, const std::vector<Body<D>>& bodies, const Joints<D>& joints, const Surroundings<D>& around);

}  // namespace weir::rigid
