// A window that shows what was drawn by one copy of its colours. VTK's own copies colours and depths to a second buffer first, and both
// from there to the window's: without a graphics card these three passes over all pixels cost more than the drawing of a small scene.
#pragma once

#include <vtkSmartPointer.h>

class vtkRenderWindow;

namespace weir::live {

/// VTK's own where it has no window of X.
vtkSmartPointer<vtkRenderWindow> quick_window();

}  // namespace weir::live
