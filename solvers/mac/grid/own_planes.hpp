// Distributed storage of a scene on a staggered grid: whether it is possible, and how.
#pragma once
#include "parallel/partition.hpp"
#include "parallel/slab.hpp"
#include "scene/replicated_work.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::mac {

/// Returns whether fields have distributed storage: not where whole fields are read on all ranks, nor where the pressure solve is
/// replicated.
bool holds_own_planes(const scene::Scene& scene, const Partition& cut);
/// The same by the scene alone, without requests for whole fields.
bool could_hold_own_planes(const scene::Scene& scene, const Partition& cut);
/// The replicated work of the pressure solve: the small levels of a distributed "multigrid", the matrix of PETSc, otherwise all.
scene::ReplicatedWorks replicated_pressure(const scene::Scene& scene, const Partition& cut);
/// This rank's planes of the scene's grid, with `ghost_planes` ghost planes or, where whole fields are read on all ranks, memory for all.
template <int D>
const Slab* slab_of(const scene::Scene& scene, const Partition& partition, int ghost_planes);

}  // namespace weir::mac
