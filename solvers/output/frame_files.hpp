// Fields as VTK's XML files. Over ranks that hold their own part of the fields alone each gives that part; of fields that all ranks hold
// whole, the first.
#pragma once
#include "core/solver.hpp"
#include "core/surface_mesh.hpp"
#include "output/frames.hpp"
#include "output/vtk_file.hpp"

#include <string>

namespace weir::output {

/// Grid fields as cell data of an image. Face fields are interpolated to the cells' centres, as vectors of three components.
VtkFile image_of(const FieldSet& fields, real t, const FrameOptions& options);
/// Component `axis` of every chosen face field, as point data of an image whose points are the centres of the faces across that axis.
VtkFile face_image_of(const FieldSet& fields, int axis, real t, const FrameOptions& options);
/// One particle set: vertices at "position", and its other fields. All ranks ask for it together.
VtkFile particles_of(const FieldSet& fields, const std::string& set, real t, const FrameOptions& options);
/// Triangles with "Normals", "velocity" where it is known, and "thickness" at their corners; over ranks each has a part. All ranks ask for
/// it together.
VtkFile surface_of(const SurfaceMesh& mesh, real t, const FrameOptions& options);

/// Whether `options` choose this field.
bool chosen(const FrameOptions& options, const FieldView& field);

}  // namespace weir::output
