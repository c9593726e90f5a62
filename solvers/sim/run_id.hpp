// Which run a checkpoint and the files of a folder belong to.
#pragma once
#include "core/checkpoint.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::sim {

/// A digest of the scene as understood: runs of the same scene have the same id, whatever their threads and ranks, as their files have the
/// same bytes.
std::string run_id(const scene::Scene& scene);
void put_run_id(Checkpoint& to, const std::string& run);
/// The run that wrote the checkpoint. One that no run wrote (Simulation::save) is of the run of its scene. Throws BadInput.
std::string run_id_of(const Checkpoint& checkpoint);

}  // namespace weir::sim
