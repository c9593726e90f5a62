// Compiled as C++17: VTK 9.1's vtkSMPTools.h is not valid C++20 (it names a constructor with template arguments).
#include "surfaces/vtk_threads.hpp"

#include <string>

#include <vtkSMPTools.h>

namespace weir::surfaces {

void with_vtk_threads(int threads, const std::function<void()>& work) {
    const std::string backend = threads == 1 ? "Sequential" : vtkSMPTools::GetBackend();
    vtkSMPTools::LocalScope(vtkSMPTools::Config(threads, backend, false), work);
}

}  // namespace weir::surfaces
