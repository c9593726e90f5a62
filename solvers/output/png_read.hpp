// PNG files (ISO/IEC 15948) of 8-bit RGB in rows, which is what pictures of ours are, read back. Our own reader, because a file may be
// damaged anywhere: VTK 9.1's ends the program where libpng refuses one.
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

/// Nothing where the file is missing, damaged, or a PNG of another kind.
std::optional<ReadPicture> read_png(const std::filesystem::path& file);

}  // namespace weir::output
