// Initial liquid volume of a scene per plane, without building the scene.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace weir::geometry {

/// The fraction of the cells of a plane of the slowest axis whose centres lie in liquid and outside solids, from at most some ten thousand
/// evenly spread cells.
template <int D>
real liquid_fraction_of_plane(const scene::Scene& scene, int plane);

/// Number of liquid cells of a plane of the slowest axis, and of cells near its surface on either side.
struct PlaneOfLiquid {
    real wet = 0, near = 0;
};

/// For all planes: cells within `beside` [m] of the surface, along an axis; estimated from at most 64 x 64 evenly spread cells of a plane
/// (4096 in 2D).
template <int D>
std::vector<PlaneOfLiquid> liquid_in_planes(const scene::Scene& scene, real beside);

}  // namespace weir::geometry
