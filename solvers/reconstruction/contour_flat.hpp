// The zero of a plane of samples as lines, by marching squares (Lorensen & Cline 1987, in 2D).
#pragma once
#include "core/surface_mesh.hpp"
#include "reconstruction/piece.hpp"
#include "reconstruction/samples.hpp"

namespace weir::reconstruction {

/// Points and lines of the mesh: loops with the liquid on their left. Samples at the edges of the plane must be outside, so that they
/// close. Of a plane of which a rank has some layers of rows: of these and those beside them, numbered from its first point.
Piece contour_flat(const Samples& samples, SurfaceMesh& mesh);

}  // namespace weir::reconstruction
