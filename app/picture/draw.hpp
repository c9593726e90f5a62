// One frame as a picture, whatever it is a frame of.
#pragma once
#include "app/picture/canvas.hpp"
#include "output/read_frame.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::picture {

struct Wishes {
    std::string field{};  // smoke, speed, ..., or "water"; empty: what the frame is about
    int size = 900;       // pixels of the longer side
    real range = 0;       // of colours; 0: the frame's own
    bool grid = false;    // cells that hold liquid (2D)
};

/// Throws BadInput where the frame does not have what is wished for.
Canvas draw(const scene::Scene& scene, output::FrameData frame, const Wishes& wishes);

}  // namespace weir::picture
