// What a run left in its folder besides frames.
#pragma once
#include "scene/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::app {

/// The scene as run.json keeps it, overrides included. Throws BadInput where the folder is not one of a run.
scene::Scene scene_of_run(const std::filesystem::path& folder);
/// The last frame at or before `time` [s]; the last of all where `time` is negative.
std::size_t frame_at(const std::vector<real>& times, real time);

}  // namespace weir::app
