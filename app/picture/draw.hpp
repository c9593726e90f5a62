// One frame of a run as a picture, as `weir picture`, `weir movie` and notebooks draw it.
#pragma once
#include "app/picture/canvas.hpp"
#include "output/read_frame.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace weir::picture {

/// Values of the lowest and of the highest colour; what is not said is the frame's own. Where the highest alone is said, the lowest of what
/// has no sign is 0, that of a field with both signs as far below 0, and that of any other the frame's own.
struct Range {
    std::optional<double> low{}, high{};
};
/// "HIGH" or "LOW,HIGH". Throws BadInput.
Range range_of(const std::string& text);

/// How a frame is to be drawn.
struct Options {
    std::string field{};  // empty: what the run is about
    Range range{};
    int size = 0;  // 0: the usual one
    bool grid = false, quality = false;
    std::string surface{};  // how the liquid's surface is made; empty: as the scene says
};

/// Throws BadInput where the frame has not what is asked for.
Canvas draw(const scene::Scene& scene, output::FrameData frame, const Options& options);
/// A frame of a folder.
Canvas draw_frame(const std::filesystem::path& folder, const scene::Scene& scene, std::size_t number, const Options& options);

}  // namespace weir::picture
