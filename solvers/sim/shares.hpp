// What each of several ranks has of a scene.
#pragma once
#include "core/halo.hpp"
#include "sim/registry.hpp"

#include <string>
#include <vector>

namespace weir::sim {

/// What each of so many ranks has of a scene that begins, in words and as solvers are asked for it.
struct Shares {
    scene::Shared shared = scene::Shared::by_planes;
    Cut cut{};  // of planes; none for one rank, where particles are shared (their cut moves with them), and where every rank does all
    std::string by_all{};  // what of a step every rank does alone
    bool nothing_shared() const { return shared == scene::Shared::by_planes && cut.empty(); }
};
Shares shares_of(const scene::Scene& scene, int ranks, const std::vector<scene::SolverKind>& kinds = registry());
Shares shares_of(const scene::Scene& scene, int ranks, const scene::SolverKind& kind);

}  // namespace weir::sim
