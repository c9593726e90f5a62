// Contact spheres: balls inside bodies that touch their surface. For balls and capsules they are exact. Edges and rims of boxes and
// cylinders are rows of small spheres, exact against planes.
#pragma once
#include "rigid/body.hpp"

namespace weir::rigid {

template <int D>
std::vector<ContactSphere<D>> contact_spheres_of(const scene::Table& shape);

}  // namespace weir::rigid
