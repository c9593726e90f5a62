// Registration of a solver: its schema and factory, listed once in sim/registry.cpp. All other parts (messages, describe, run, validate,
// studies) use the registry.
#pragma once
#include "core/solver.hpp"
#include "scene/replicated_work.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace weir {
struct Partition;  // parallel/partition.hpp
}  // namespace weir

namespace weir::scene {

/// The fields and passes of a scene without effects, solids, emitters and sinks, by name.
struct PlainStep {
    std::vector<std::string> fields{};
    std::vector<std::string> passes{};
    std::string scene{};  // additional keys of a small scene of this kind, as TOML; "<x>" stands for a list of x for each axis
};

/// What is distributed among ranks: the planes of the slowest axis, or the particles in equal parts in the order of their cells.
enum class Shared { by_planes, by_particles };

/// What a solver provides for runs in parallel (MPI).
struct ParallelSupport {
    /// Rejects, at its key, scenes that are not supported in parallel. Empty: the solver runs in one process only.
    std::function<void(const Scene&)> check{};
    /// What is distributed over the ranks.
    Shared shared = Shared::by_planes;
    /// The replicated work of a step of this scene with this partition; an empty list, or no function: none.
    std::function<ReplicatedWorks(const Scene&, const Partition&)> replicated_work{};
    /// Returns whether a scene with this partition has distributed storage. Empty: all ranks store everything.
    std::function<bool(const Scene&, const Partition&)> distributed_storage{};
    /// The partition of a scene's planes among `ranks` ranks; an empty one: replicated work. No function: the equal parts of
    /// equal_partition.
    std::function<Partition(const Scene&, int ranks)> partition{};
    /// The work of a step per plane of the slowest axis, in any unit: at the start of a scene, or for a state (collective). Empty: equal
    /// for all planes.
    std::function<std::vector<std::int64_t>(const Scene&, const Checkpoint*)> work_of_planes{};
};

struct SolverKind {
    SolverSchema schema;
    /// Constructs the solver of a scene. In parallel this rank gets its part of the partition; an empty one: every rank does all work.
    std::function<std::unique_ptr<Solver>(const Scene&, const Partition&)> make;
    PlainStep plain{};
    ParallelSupport parallel{};
};

/// The schemas of these solvers.
std::vector<SolverSchema> schemas_of(const std::vector<SolverKind>& kinds);

/// The effects of a scene with zero strength: they may cost time but have no effect.
std::vector<std::string> idle_effects(const Scene& scene, const SolverSchema& schema);

}  // namespace weir::scene
