// Postprocessing of a contour: smoothing where there are many particles, normals, and the thickness of the liquid. In parallel each rank
// processes its own points.
#pragma once
#include "core/surface_mesh.hpp"
#include "surfaces/piece.hpp"
#include "surfaces/samples.hpp"

#include <vector>

namespace weir::surfaces {

/// Weighted Laplacian smoothing (Loeschner et al. 2023, eq. 6): each point moves towards the mean of its neighbours by its weight. In each
/// pair of steps the second moves back slightly farther (Taubin 1995): 25 plain steps as published, on cells of one spacing, remove a tenth
/// of the volume of a sphere of 16 spacings. Weights are those of own points. In parallel, with this partition of the planes of samples,
/// adjacent points are exchanged after each step.
void smooth(SurfaceMesh& mesh, const Piece& piece, const std::vector<real>& weight, int passes, const Partition& cut = {});
/// Normal of each point: area-weighted mean of the adjacent triangles, or length-weighted mean of its two lines.
void add_normals(SurfaceMesh& mesh);
/// Thickness along the inward normal of each own point, up to the point where the samples become negative. In parallel, with this partition
/// of the planes of samples, a ray that leaves this rank continues on the owner.
void add_thickness(SurfaceMesh& mesh, const Piece& piece, const Samples& samples, const Partition& cut = {});

}  // namespace weir::surfaces
