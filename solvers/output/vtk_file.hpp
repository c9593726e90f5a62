// VTK's XML files of images and of points, with raw appended data, as VTK 9.1's own writers leave them, byte for byte. All ranks write one
// together: each encodes the blocks of an array that begin in its part, and no rank holds more than its part of one array.
#pragma once
#include "output/data_array.hpp"
#include "output/frames.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

struct VtkElement {
    std::string name, attributes;
    std::vector<DataArray> arrays{};
};

struct VtkFile {
    std::string type, version;  // what is in it: "ImageData", and the version of that
    std::string attributes, piece;
    real time = 0;
    std::vector<VtkElement> elements{};
};

/// An attribute with room behind it, as VTK leaves some, which it fills when all is written.
std::string with_room(const std::string& name, const std::string& value, std::size_t room = 20);

/// All ranks call it together. Throws OutputError, on all ranks; what stood under this name stays readable then.
void write(const std::filesystem::path& path, const VtkFile& file, Compression compression);

}  // namespace weir::output
