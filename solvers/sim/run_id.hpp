// Identifies the run that a checkpoint and the files of a folder belong to.
#pragma once
#include "core/checkpoint.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <string>

namespace weir::sim {

/// A digest of the parsed scene and of the files that it names. Runs of the same scene have the same id for any number of threads and
/// ranks, as their files have the same bytes.
std::string run_id(const scene::Scene& scene);
/// The id of a run of this scene that continues run `continued` after `steps` steps in a folder of its own. Returns `continued` where the
/// scene is the same.
std::string branch_id(const scene::Scene& scene, const std::string& continued, std::int64_t steps);
/// What a run is called, and its folder: "cases/plume" and "cases/plume/scene.toml" are both plume.
std::string scene_name(const scene::Scene& scene);
void put_run_id(Checkpoint& to, const std::string& run);
/// The run that wrote the checkpoint. A checkpoint that no run wrote (Simulation::save) belongs to the run of its scene. Throws BadInput.
std::string run_id_of(const Checkpoint& checkpoint);

}  // namespace weir::sim
