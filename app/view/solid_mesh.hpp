// The solids and bodies of a scene as a mesh: their surface (3D), or the area that they cover (2D).
#pragma once
#include "scene/scene.hpp"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstddef>
#include <functional>

namespace weir::view {

/// A component of a field of the set of bodies ("position", "orientation") of the body with this number.
using PoseOf = std::function<real(const char* field, std::size_t component, std::size_t body)>;

/// At `time`, in the box x0 x1 y0 y1 z0 z1 of cells of this width [m]; null where there are none.
vtkSmartPointer<vtkPolyData> solid_mesh(const scene::Scene& scene, real time, const PoseOf& pose, const std::array<real, 6>& box,
                                        real cell);

}  // namespace weir::view
