// The frames that a scene requests, from its `output` table: for `weir run`, Python and cases alike.
#pragma once
#include "output/frame_format.hpp"
#include "scene/scene.hpp"

namespace weir::sim {

/// Format, fields, precision and compression of frames, and the solids and the surface of the scene.
output::FrameOptions frame_options(const scene::Scene& scene);
/// Returns why this build cannot write frames in the scene's format; empty: it can.
const std::string& frames_unavailable(const scene::Scene& scene);

}  // namespace weir::sim
