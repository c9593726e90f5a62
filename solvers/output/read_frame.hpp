// A frame read back from its VTK files into plain arrays: what the makers of pictures need of VTK.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

/// Components of one quantity, each with a value a cell or a particle.
using Components = std::vector<std::vector<real>>;

struct FrameData {
    real time = 0;  // [s]
    GridView grid;  // dim 0 where the series has no grid
    std::map<std::string, Components> cells;
    std::map<std::string, std::map<std::string, Components>> particles;  // by set, then by field ("position", ...)
};

/// Times of the frames in an output folder. Throws BadInput where there is none.
std::vector<real> frame_times(const std::filesystem::path& folder);
/// Every file of frame number `frame`. `dim` as the scene says: a flat image does not tell. Throws BadInput.
FrameData read_frame(const std::filesystem::path& folder, std::size_t frame, int dim);

/// The frame that a solver's fields of the moment would be.
FrameData frame_of(const FieldSet& fields, real t);

}  // namespace weir::output
