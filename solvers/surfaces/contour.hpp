// The zero level set of samples as triangles, by VTK's flying edges (Schroeder, Maynard & Geveci 2015). The only file that uses VTK's
// filters.
#pragma once
#include "core/surface_mesh.hpp"
#include "surfaces/piece.hpp"
#include "surfaces/samples.hpp"

namespace weir::surfaces {

/// Returns whether this build supports it (WEIR_VTK).
bool can_contour();
/// Computes points and corners of the mesh. Samples at the ends of the lattice must be outside, so that the mesh is closed. For a
/// distributed lattice: those of this rank's layers and the adjacent ones, numbered from its first point. Throws BadInput without VTK.
Piece contour(const Samples& samples, SurfaceMesh& mesh);

}  // namespace weir::surfaces
