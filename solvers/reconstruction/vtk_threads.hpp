// How many threads VTK's filters take.
#pragma once
#include <functional>

namespace weir::reconstruction {

/// Does the work with filters that take at most so many threads.
void with_vtk_threads(int threads, const std::function<void()>& work);

}  // namespace weir::reconstruction
