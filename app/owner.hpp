// Which run the files of an output folder belong to. A checkpoint continues the run whose files stand beside it, and no other.
#pragma once
#include "scene/scene.hpp"

#include <filesystem>
#include <string>

namespace weir::app {

/// Before a new run writes to a folder: checkpoints of an earlier run there get other names, so that none of them continues this one. The
/// run owns the folder. Safe against an end at any moment: until run.json is replaced, the files are those of the earlier run.
/// Returns the id of the run, the same on all ranks.
std::string own(const std::filesystem::path& folder, const scene::Scene& scene, bool quiet);

/// The same of a run that goes on from a checkpoint of run `continued`. Throws BadInput where the folder has files of another run.
std::string own(const std::filesystem::path& folder, const scene::Scene& scene, const std::string& continued);

/// The name that a checkpoint of an earlier run gets.
std::filesystem::path earlier(const std::filesystem::path& checkpoint);

}  // namespace weir::app
