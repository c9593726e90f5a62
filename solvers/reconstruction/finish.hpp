// What a contour gets before it is shown: smoothness where there are many particles, normals, and the thickness of the liquid. Over ranks
// each finishes its own points.
#pragma once
#include "core/surface_mesh.hpp"
#include "reconstruction/piece.hpp"
#include "reconstruction/samples.hpp"

#include <vector>

namespace weir::reconstruction {

/// Passes of weighted Laplacian smoothing (Loeschner et al. 2023, eq. 6): each point moves towards the mean of those around it by its
/// weight. Of each two steps the second goes back a little farther (Taubin 1995), because 25 plain ones as published, on cells of a
/// spacing, take a tenth of the volume of a sphere of 16 spacings. Weights are of own points. Over ranks, whose planes of samples are cut
/// so, points beside come from their owners after each step.
void smooth(SurfaceMesh& mesh, const Piece& piece, const std::vector<real>& weight, int passes, const Cut& cut = {});
/// Of each point: the mean of the triangles around it, by area, or of its two lines, by length.
void add_normals(SurfaceMesh& mesh);
/// Along the inward normal from each own point, where the samples become negative. Over ranks, whose planes of samples are cut so, a line
/// that leaves this rank's goes on where they are known.
void add_thickness(SurfaceMesh& mesh, const Piece& piece, const Samples& samples, const Cut& cut = {});

}  // namespace weir::reconstruction
