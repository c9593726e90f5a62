// Parts of weir that bring many libraries of others with them stand in libraries of their own, loaded when they are needed.
#pragma once
#include <string>

namespace weir {

/// The function `entry` of `file` ("libweir_petsc.so"), beside the running program as a build has it, in its prefix as an installation has
/// it, where it was built (empty: it was not), or wherever the loader finds it. nullptr where it is not.
void* entry_of_library(const std::string& file, const std::string& built, const char* entry);

}  // namespace weir
