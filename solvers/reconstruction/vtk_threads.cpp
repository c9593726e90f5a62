// Compiled as C++17: VTK 9.1's vtkSMPTools.h is no C++20 (a constructor is named with its template arguments).
#include "reconstruction/vtk_threads.hpp"

#include <vtkSMPTools.h>

namespace weir::reconstruction {

void with_vtk_threads(int threads, const std::function<void()>& work) { vtkSMPTools::LocalScope(vtkSMPTools::Config(threads), work); }

}  // namespace weir::reconstruction
