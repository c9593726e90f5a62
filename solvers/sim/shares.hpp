// The partition of a scene among several ranks.
#pragma once
#include "parallel/partition.hpp"
#include "sim/registry.hpp"

#include <string>
#include <vector>

namespace weir::sim {

/// The part of each rank at the start of a scene, as text and as an argument for solvers.
struct Shares {
    scene::Shared shared = scene::Shared::by_planes;
    Partition cut{};  // of planes; empty for one rank, for shared particles (their partition moves with them), and for replicated work
    scene::ReplicatedWorks replicated_work{};
    bool nothing_shared() const { return shared == scene::Shared::by_planes && cut.empty(); }
};
Shares shares_of(const scene::Scene& scene, int ranks, const std::vector<scene::SolverKind>& kinds = registry());
Shares shares_of(const scene::Scene& scene, int ranks, const scene::SolverKind& kind);

/// The partition of a scene without knowledge of the work of its planes.
Partition equal_shares(const scene::Scene& scene, int ranks, const scene::SolverKind& kind);

}  // namespace weir::sim
