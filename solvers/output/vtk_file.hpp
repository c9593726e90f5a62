// VTK's XML files of images and points with raw appended data, byte for byte as written by VTK 9.1. All ranks write one file together: each
// encodes the blocks of an array that start in its part, and no rank stores more than its part of one array.
#pragma once
#include "output/data_array.hpp"
#include "output/frame_format.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

struct VtkElement {
    std::string name, attributes;
    std::vector<DataArray> arrays{};
};

struct VtkFile {
    std::string type, version;  // its content, "ImageData", and the version of that format
    std::string attributes, piece;
    real time = 0;
    std::vector<VtkElement> elements{};
};

/// An attribute followed by padding, as reserved by VTK for values known at the end.
std::string with_room(const std::string& name, const std::string& value, std::size_t room = 20);

/// Collective. Throws OutputError, on all ranks; the previous file stays readable then.
void write(const std::filesystem::path& path, const VtkFile& file, Compression compression);

}  // namespace weir::output
