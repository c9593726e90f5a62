// Parts of weir with large dependencies are libraries of their own, loaded when they are needed.
#pragma once
#include <string>

namespace weir {

/// Loads the function `entry` of `file` ("libweir_petsc.so"). Searched: beside the running program (build), in its prefix (installation),
/// the path `built` (empty: not built), and the loader's path. Returns nullptr where it is not found.
void* entry_of_library(const std::string& file, const std::string& built, const char* entry);

}  // namespace weir
