// One frame of a run as a picture, as `weir picture`, `weir movie` and notebooks draw it.
#pragma once
#include "app/picture/canvas.hpp"
#include "output/read_frame.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <string>

namespace weir::picture {

/// How a frame is to be drawn.
struct Wish {
    std::string field{};  // empty: what the run is about
    double range = 0;     // 0: the frame's own
    int size = 0;         // 0: the usual one
    bool grid = false, quality = false;
};

/// Throws BadInput where the frame has not what is asked for.
Canvas draw(const scene::Scene& scene, output::FrameData frame, const Wish& wish);
/// A frame of a folder.
Canvas draw_frame(const std::filesystem::path& folder, const scene::Scene& scene, std::size_t number, const Wish& wish);

}  // namespace weir::picture
