// How much of a scene's planes is liquid as it begins, without building it.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace weir::geometry {

/// The part of the cells of a plane of the slowest axis whose centres lie in liquid and outside solids; of at most some ten thousand of
/// them, evenly spread.
template <int D>
real wet_part_of_plane(const scene::Scene& scene, int plane);

/// Cells of a plane of the slowest axis in liquid, and within some distance of its surface on either side.
struct PlaneOfLiquid {
    real wet = 0, near = 0;
};

/// Of all planes, within `beside` [m] of the surface, along an axis; found from at most 64 x 64 cells of a plane (4096 in 2D), evenly
/// spread.
template <int D>
std::vector<PlaneOfLiquid> liquid_in_planes(const scene::Scene& scene, real beside);

}  // namespace weir::geometry
