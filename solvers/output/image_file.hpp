// Pictures as files: PNG for what is kept, JPEG for what a page carries in itself.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

/// 8-bit RGB, row by row from the top. Throws BadInput where weir was built without VTK.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::uint8_t>& rgb);

/// The bytes of a PNG file's picture as JPEG (ITU T.81) of quality 88: rendered pictures take a fourth of the room and no eye sees the
/// difference. Empty where the file is no picture that can be read, or weir was built without VTK.
std::string jpeg_of(const std::filesystem::path& png);

}  // namespace weir::output
