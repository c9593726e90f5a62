#include "core/library.hpp"

#include <filesystem>

#include <dlfcn.h>

namespace weir {

void* entry_of_library(const std::string& file, const std::string& built, const char* entry) {
    std::error_code unknown;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
    for (const std::string& path : {(program / file).string(), (program / "../lib/weir" / file).string(), built, file}) {
        if (path.empty()) continue;
        // Open MPI's plugins look up its symbols in the global scope.
        if (void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL))
            if (void* found = dlsym(library, entry)) return found;
    }
    return nullptr;
}

}  // namespace weir
