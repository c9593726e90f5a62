// Fields as VTK's XML files. In parallel with distributed storage each rank provides its part; fields stored whole are provided by rank 0.
#pragma once
#include "core/solver.hpp"
#include "core/surface_mesh.hpp"
#include "output/frame_format.hpp"
#include "output/vtk_file.hpp"

#include <string>

namespace weir::output {

/// Grid fields as cell data of an image.
VtkFile image_of(const FieldSet& fields, real t, const FrameOptions& options);
/// Component `axis` of every chosen face field, as point data of an image whose points are the centres of the faces across that axis.
VtkFile face_image_of(const FieldSet& fields, int axis, real t, const FrameOptions& options);
/// One particle set: vertices at "position", and its other fields. Collective.
VtkFile particles_of(const FieldSet& fields, const std::string& set, real t, const FrameOptions& options);
/// Triangles with "Normals", "velocity" where known, and "thickness" at their corners; in parallel each rank has a part. Collective.
VtkFile surface_of(const SurfaceMesh& mesh, real t, const FrameOptions& options);

}  // namespace weir::output
