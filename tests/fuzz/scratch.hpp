// Bytes as a file, for readers that take a path.
#pragma once
#include "support/temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace weir::fuzz {

/// In memory where the machine has such a file system: a fuzzer writes thousands a second.
inline const std::filesystem::path& scratch_folder() {
    static const test::TemporaryFolder folder;
    return folder.path();
}

inline std::filesystem::path written(const std::string& name, std::string_view bytes) {
    const auto file = scratch_folder() / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

}  // namespace weir::fuzz
