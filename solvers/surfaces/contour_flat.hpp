// The zero level set of a plane of samples as lines, by marching squares (Lorensen & Cline 1987, in 2D).
#pragma once
#include "core/surface_mesh.hpp"
#include "surfaces/piece.hpp"
#include "surfaces/samples.hpp"

namespace weir::surfaces {

/// Computes points and lines of the mesh: loops with the liquid on their left. Samples at the edges of the plane must be outside, so that
/// the loops are closed. For a distributed plane: those of this rank's rows and the adjacent ones, numbered from its first point.
Piece contour_flat(const Samples& samples, SurfaceMesh& mesh);

}  // namespace weir::surfaces
