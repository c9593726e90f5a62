// Reads a frame from its VTK files into plain arrays, for rendering.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

/// Components of one quantity, each with a value per cell or particle.
using Components = std::vector<std::vector<real>>;

struct FrameData {
    real time = 0;  // [s]
    GridView grid;  // dim 0 where the series has no grid
    std::map<std::string, Components> cells;
    std::map<std::string, std::map<std::string, Components>> particles;  // by set, then by field ("position", ...)
};

/// Times of the frames in an output folder. Throws BadInput where there is none.
std::vector<real> frame_times(const std::filesystem::path& folder);
/// Reads all files of frame number `frame`. `dim`: that of the scene, which an image of one layer does not show. Throws BadInput.
FrameData read_frame(const std::filesystem::path& folder, std::size_t frame, int dim);

/// The frame of a solver's present fields.
FrameData frame_of(const FieldSet& fields, real t);

}  // namespace weir::output
