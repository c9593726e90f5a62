// Reads PNG files (ISO/IEC 15948) of 8-bit RGB, the format written by weir. Implemented here because a file may be damaged anywhere: VTK
// 9.1's reader terminates the program where libpng reports an error.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace weir::output {

struct ReadPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb{};  // row by row from the top
};

/// nullopt where the file is missing, damaged, or a PNG of another kind.
std::optional<ReadPicture> read_png(const std::filesystem::path& file);

}  // namespace weir::output
