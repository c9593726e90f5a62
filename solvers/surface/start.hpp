// The level set of the shapes of liquid that a scene begins with.
#pragma once
#include "geometry/shape.hpp"
#include "geometry/solids.hpp"
#include "surface/level_set.hpp"

namespace weir::surface {

/// φ of the free surface of a shape of liquid: distance to that part of the shape's boundary which is not a wall or a solid.
template <int D>
void start_level_set(const geometry::Shape<D>& liquid, const geometry::Solids<D>& solids, const Frame<D>& frame, LevelSet<D>& surface);

}  // namespace weir::surface
