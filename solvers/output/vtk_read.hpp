// Reads VTK's XML files of images and points with raw appended data. Implemented here because a file may be damaged anywhere: VTK 9.1
// crashes on some damaged files and accepts others. Every count is compared with the available bytes before use.
#pragma once
#include "core/types.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

/// Tuples with a fixed number of components, contiguous.
struct ReadArray {
    std::string name;
    std::size_t components = 1;
    std::vector<real> values{};
    bool bytes = false;  // small integers: VTK's flags of hidden cells
    std::size_t tuples() const { return values.size() / components; }
};

/// The connectivity: concatenated corners of all cells, and the end of each in that list.
struct ReadCells {
    std::vector<std::int64_t> corners{}, ends{};
};

struct ReadFile {
    bool image = false;                  // otherwise points
    std::array<int, 3> points{1, 1, 1};  // of an image along each axis
    std::array<real, 3> origin{}, spacing{};
    std::vector<ReadArray> cell_data{}, point_data{};
    std::vector<real> position{};  // three numbers per point
    ReadCells vertices{}, lines{}, polygons{};
};

/// Throws BadInput naming the file and the damage.
ReadFile read_vtk(const std::filesystem::path& file);

}  // namespace weir::output
