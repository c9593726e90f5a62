// The zero of samples as triangles, by VTK's flying edges (Schroeder, Maynard & Geveci 2015). The only place that knows VTK's filters.
#pragma once
#include "core/surface_mesh.hpp"
#include "reconstruction/piece.hpp"
#include "reconstruction/samples.hpp"

namespace weir::reconstruction {

/// Whether this build can (WEIR_VTK).
bool can_contour();
/// Points and corners of the mesh; the samples at the ends of the lattice must be outside, so that it closes. Of a lattice of which a rank
/// has some layers: of these and those beside them, numbered from its first point. Throws BadInput without VTK.
Piece contour(const Samples& samples, SurfaceMesh& mesh);

}  // namespace weir::reconstruction
