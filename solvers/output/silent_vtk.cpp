#include "output/silent_vtk.hpp"

#include <vtkObject.h>

namespace weir::output {

SilentVtk::SilentVtk() : before_(vtkObject::GetGlobalWarningDisplay()) { vtkObject::SetGlobalWarningDisplay(0); }
SilentVtk::~SilentVtk() { vtkObject::SetGlobalWarningDisplay(before_); }

}  // namespace weir::output
