// Pictures as files: PNG for what is kept, JPEG for what a page carries in itself.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

/// 8-bit RGB, row by row from the top. `made_as`, where it is not empty, is kept in the file as its "Source" (a tEXt chunk of PNG). Throws
/// BadInput where weir was built without VTK.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::uint8_t>& rgb,
               const std::string& made_as = {});

/// Whether the file is a PNG that was written with this `made_as`.
bool was_made_as(const std::filesystem::path& png, const std::string& made_as);

/// The bytes of a PNG file's picture as JPEG (ITU T.81) of quality 88: rendered pictures take a fourth of the room and no eye sees the
/// difference. Empty where the file is no picture as write_png() writes them, or weir was built without VTK.
std::string jpeg_of(const std::filesystem::path& png);

}  // namespace weir::output
