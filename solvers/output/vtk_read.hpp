// VTK's XML files of images and of points, with raw appended data, read back. Our own reader, because a file may be damaged anywhere: VTK
// 9.1 crashes at some such files and takes others for frames. Every count is compared with the bytes that are there before it is used.
#pragma once
#include "core/types.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

/// A number of tuples of so many components, one after another.
struct ReadArray {
    std::string name;
    std::size_t components = 1;
    std::vector<real> values{};
    bool bytes = false;  // of small whole numbers: what VTK hides cells by
    std::size_t tuples() const { return values.size() / components; }
};

/// Which points belong together: the corners of all, one cell after another, and where each ends in that list.
struct ReadCells {
    std::vector<std::int64_t> corners{}, ends{};
};

struct ReadFile {
    bool image = false;                  // else points
    std::array<int, 3> points{1, 1, 1};  // of an image along each axis
    std::array<real, 3> origin{}, spacing{};
    std::vector<ReadArray> cell_data{}, point_data{};
    std::vector<real> position{};  // three numbers a point
    ReadCells vertices{}, lines{}, polygons{};
};

/// Throws BadInput naming the file and what is damaged.
ReadFile read_vtk(const std::filesystem::path& file);

}  // namespace weir::output
