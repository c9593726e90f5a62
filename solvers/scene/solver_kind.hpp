// How a solver joins the program: its schema and its maker, registered once in sim/registry.cpp. Everything else (messages, describe,
// run, validate, studies) finds it there.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace weir {
struct Cut;  // core/halo.hpp
struct RankOf;
struct StepShape;
struct StepTraffic;  // core/traffic.hpp
}  // namespace weir

namespace weir::scene {

/// What a scene without effects, solids, emitters and sinks gets, and nothing beside it: fields and passes by name.
struct PlainStep {
    std::vector<std::string> fields{};
    std::vector<std::string> passes{};
    std::string scene{};  // what a small scene of its kind says beside its grid, as TOML; "<x>" stands for a list of x for each axis
};

/// What ranks divide among themselves: the planes of the slowest axis, or the particles in the order of their cells, as many to each.
enum class Shared { by_planes, by_particles };

struct SolverKind {
    SolverSchema schema;
    std::function<std::unique_ptr<Solver>(const Scene&)> make;
    PlainStep plain{};
    /// Refuses, at its key, what of a scene cannot run over several ranks. None: the solver runs in one process only.
    std::function<void(const Scene&)> over_ranks{};
    /// What each of several ranks takes its share of.
    Shared shared = Shared::by_planes;
    /// What of a step of such a scene, cut so, every rank does alone, in a few words; nothing, or none: all of it is shared.
    std::function<std::string(const Scene&, const Cut&)> by_all{};
    /// Whether each rank would hold its own part of a scene that is cut so alone. None: all hold everything.
    std::function<bool(const Scene&, const Cut&)> holds_own_part{};
    /// What a rank sends in such a step, by formula. None: not known.
    std::function<StepTraffic(const Scene&, const RankOf&, const StepShape&)> sends{};
    /// Where the planes of a scene are cut among so many ranks; nowhere (an empty cut): every rank does all of it. None: as equal as
    /// cut_of makes them.
    std::function<Cut(const Scene&, int ranks)> cut{};
    /// What a step takes of each plane of the slowest axis, in any unit: as a scene begins, or of a state (over ranks all ask together).
    /// None: as much of each.
    std::function<std::vector<std::int64_t>(const Scene&, const Checkpoint*)> work_of_planes{};
};

/// What each may be told.
std::vector<SolverSchema> schemas_of(const std::vector<SolverKind>& kinds);

/// The effects that a scene names with a strength of zero: they may cost, and do nothing.
std::vector<std::string> idle_effects(const Scene& scene, const SolverSchema& schema);

}  // namespace weir::scene
