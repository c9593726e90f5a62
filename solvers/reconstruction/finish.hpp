// What a contour gets before it is shown: smoothness where there are many particles, normals, and the thickness of the liquid.
#pragma once
#include "core/surface_mesh.hpp"
#include "reconstruction/samples.hpp"

#include <vector>

namespace weir::reconstruction {

/// Passes of weighted Laplacian smoothing (Loeschner et al. 2023, eq. 6): each point moves towards the mean of those around it by its
/// weight. Of each two steps the second goes back a little farther (Taubin 1995), because 25 plain ones as published, on cells of a
/// spacing, take a tenth of the volume of a sphere of 16 spacings.
void smooth(SurfaceMesh& mesh, const std::vector<real>& weight, int passes);
/// Of each point: the mean of the triangles around it, by area, or of its two lines, by length.
void add_normals(SurfaceMesh& mesh);
/// Along the inward normal from each point, where the samples become negative.
void add_thickness(SurfaceMesh& mesh, const Samples& samples);

}  // namespace weir::reconstruction
