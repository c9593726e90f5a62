// Which run the files of an output folder belong to. A checkpoint continues the run whose files stand beside it, and no other.
#pragma once
#include "output/folder_lock.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace weir::app {

/// Keeps other runs out of a folder while it lives, which is made where it is missing. In parallel (MPI) the first rank has the lock, as it
/// writes. Throws BadInput where another run writes there, OutputError where the folder cannot be written.
std::unique_ptr<output::FolderLock> lock_folder(const std::filesystem::path& folder);

/// Before a new run writes to a folder: checkpoints of an earlier run there get other names, so that none of them continues this one, and
/// files that a killed run left unfinished are removed. The run owns the folder. Safe against an end at any moment: until run.json is
/// replaced, the files are those of the earlier run. Returns the id of the run, the same on all ranks.
std::string own_as_new(const std::filesystem::path& folder, const scene::Scene& scene, bool quiet);

/// The same of a run that goes on from a checkpoint of run `continued` after so many steps. In a folder without a run it is a run of its
/// own, a branch: the same branch again takes the place of what is there. Throws BadInput where the folder has files of another run.
std::string own_as_continued(const std::filesystem::path& folder, const scene::Scene& scene, const std::string& continued,
                             std::int64_t steps);

/// Whether the folder has files of that run.
bool holds_run(const std::filesystem::path& folder, const std::string& run);

/// The name that a checkpoint of an earlier run gets.
std::filesystem::path earlier(const std::filesystem::path& checkpoint);

}  // namespace weir::app
