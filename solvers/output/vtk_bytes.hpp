// Fields as the bytes of VTK's XML files. The only place that knows VTK's writers; without WEIR_VTK each function throws BadInput.
#pragma once
#include "core/solver.hpp"
#include "core/surface_mesh.hpp"
#include "output/frames.hpp"

#include <string>

namespace weir::output {

/// Grid fields as cell data of an image. Face fields are interpolated to the cells' centres, as vectors of three components.
std::string image_bytes(const FieldSet& fields, real t, const FrameOptions& options);
/// Component `axis` of every chosen face field, as point data of an image whose points are the centres of the faces across that axis.
std::string face_image_bytes(const FieldSet& fields, int axis, real t, const FrameOptions& options);
/// One particle set: vertices at "position", and its other fields.
std::string particle_bytes(const FieldSet& fields, const std::string& set, real t, const FrameOptions& options);
/// Triangles with "Normals", "velocity" where it is known, and "thickness" at their corners.
std::string surface_bytes(const SurfaceMesh& mesh, real t, const FrameOptions& options);

/// Whether `options` choose this field.
bool chosen(const FrameOptions& options, const FieldView& field);

}  // namespace weir::output
