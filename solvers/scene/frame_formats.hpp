// Names of the file formats of frames: the values of output.format. The formats are in output/formats.
#pragma once
#include <string>
#include <vector>

namespace weir::scene {

/// From WEIR_FRAME_FORMATS in solvers/CMakeLists.txt; the first is the default.
const std::vector<std::string>& frame_formats();

}  // namespace weir::scene
