// The number of threads of VTK's filters.
#pragma once
#include <functional>

namespace weir::surfaces {

/// Runs the work with filters limited to `threads` threads.
void with_vtk_threads(int threads, const std::function<void()>& work);

}  // namespace weir::surfaces
