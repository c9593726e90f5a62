// Image files: PNG for storage, JPEG for embedding in a page.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

/// 8-bit RGB, row by row from the top. `made_as`, if not empty, is stored in the file as its "Source" (a tEXt chunk of PNG). Throws
/// BadInput where weir was built without VTK.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::uint8_t>& rgb,
               const std::string& made_as = {});

/// Returns whether the file is a PNG written with this `made_as`.
bool was_made_as(const std::filesystem::path& png, const std::string& made_as);

/// Converts a PNG file to JPEG (ITU T.81) of quality 88: a fourth of the size without visible difference for rendered pictures. Empty where
/// the file is not as written by write_png(), or weir was built without VTK.
std::string jpeg_of(const std::filesystem::path& png);

}  // namespace weir::output
