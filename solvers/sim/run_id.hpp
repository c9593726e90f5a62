// Which run a checkpoint and the files of a folder belong to.
#pragma once
#include "core/checkpoint.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <string>

namespace weir::sim {

/// A digest of the scene as understood: runs of the same scene have the same id, whatever their threads and ranks, as their files have the
/// same bytes.
std::string run_id(const scene::Scene& scene);
/// Of a run of this scene that begins where run `continued` was after so many steps, in a folder of its own. That run itself where the
/// scene is its scene.
std::string branch_id(const scene::Scene& scene, const std::string& continued, std::int64_t steps);
void put_run_id(Checkpoint& to, const std::string& run);
/// The run that wrote the checkpoint. One that no run wrote (Simulation::save) is of the run of its scene. Throws BadInput.
std::string run_id_of(const Checkpoint& checkpoint);

}  // namespace weir::sim
