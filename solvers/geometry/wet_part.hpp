// How much of a scene's planes is liquid as it begins, without building it.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

namespace weir::geometry {

/// The part of the cells of a plane of the slowest axis whose centres lie in liquid and outside solids; of at most some ten thousand of
/// them, evenly spread.
template <int D>
real wet_part_of_plane(const scene::Scene& scene, int plane);

}  // namespace weir::geometry
