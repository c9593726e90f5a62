// The zero of a plane of samples as lines, by marching squares (Lorensen & Cline 1987, in 2D).
#pragma once
#include "core/surface_mesh.hpp"
#include "reconstruction/samples.hpp"

namespace weir::reconstruction {

/// Points and lines of the mesh: loops with the liquid on their left. Samples at the edges of the plane must be outside, so that they
/// close.
void contour_flat(const Samples& samples, SurfaceMesh& mesh);

}  // namespace weir::reconstruction
