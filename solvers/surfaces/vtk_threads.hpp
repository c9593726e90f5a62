// The number of threads of VTK's filters.
#pragma once
#include <functional>

namespace weir::surfaces {

/// Runs the work with filters limited to `threads` threads. With one, VTK starts no thread at all: a process forked beside a thread of TBB
/// inherits its locks, and may wait for them for ever.
void with_vtk_threads(int threads, const std::function<void()>& work);

}  // namespace weir::surfaces
