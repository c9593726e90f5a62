// Where bodies may touch: balls inside them that reach their surface. Of balls and capsules these are exact; edges and rims of boxes and
// cylinders are rows of small balls, exact against planes.
#pragma once
#include "rigid/body.hpp"

namespace weir::rigid {

template <int D>
std::vector<Feeler<D>> feelers_of(const scene::Table& shape);

}  // namespace weir::rigid
