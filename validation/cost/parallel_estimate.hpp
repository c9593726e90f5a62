// What a scene takes over several ranks, before it runs in parallel: planes, memory and messages of each rank. Messages are counted in a
// few steps of the scene by forked ranks of this machine (parallel/forked_ranks.hpp). How its steps would get on where grid and ranks grow
// together (weak scaling) is a model of three constants: seconds a cell or particle, a message's latency, bytes a second.
#pragma once
#include "parallel/forked_ranks.hpp"
#include "validation/cost/cost_estimate.hpp"

#include <optional>

namespace weir::validation {

/// The way between two ranks.
struct Link {
    double latency = 0;    // of a message [s]
    double bandwidth = 0;  // [bytes/s]
    std::string source{};  // of these numbers
};

/// Between two processes of this machine through its memory: half of a round trip of eight bytes, and some megabytes one way; the best of
/// some tries.
Link measure_link();

/// Time of a step of a rank, as the model has it [s].
struct ModelStep {
    int ranks = 1;
    double computing = 0, sending = 0;
    double efficiency() const { return computing / (computing + sending); }
};

struct ParallelEstimate {
    int ranks = 1;
    Partition cut{};              // empty where particles are shared
    bool own_part = false;        // each holds its own planes alone
    bool nothing_shared = false;  // every rank does all of it
    scene::ReplicatedWorks replicated_work{};
    std::vector<double> bytes{};          // that each holds
    std::vector<double> surface_bytes{};  // more while output.surface is made
    /// Sent per step by each of the ranks on which the scene was tried, at most most_tried.
    std::vector<RankTraffic> sent{};
    double iterations = 0;  // of a step in which these were counted
    std::string tried{};    // cells of the copy on which they were counted; empty: on the scene itself
    Link link{};
    double seconds_each = 0;        // a cell or particle and step, on one rank
    std::vector<ModelStep> weak{};  // as many planes a rank as here, on more and more of them
};

/// Messages are counted on at most as many ranks: those of a rank between two others do not depend on their number.
inline constexpr int most_tried = 8;
/// A scene with more cells than this is tried on a smaller copy of the same proportions, and bytes between neighbours grow with the planes:
/// the scene itself may not fit this machine. Measured on plume_3d with 25 million cells: 15% more bytes and 34% fewer messages than the
/// scene itself, since a copy has fewer levels. The copy must have this many planes per rank.
inline constexpr double most_cells_tried = 1e6;
inline constexpr int fewest_planes_tried = 8;

/// What each of several ranks sends in some steps, and the iterations of a step.
struct CountedSteps {
    std::vector<RankTraffic> sent{};
    double iterations = 0;
};
/// Counts it on forked ranks in `steps` steps of a scene, after the first `first` ones. Throws BadInput where the scene cannot be tried.
CountedSteps count_messages(const scene::Scene& scene, int ranks, int first, int steps,
                            const std::vector<scene::SolverKind>& kinds = sim::registry());

/// Refuses as the run itself would (sim::require_ranks). Without a link this machine's is measured.
ParallelEstimate estimate_in_parallel(const scene::Scene& scene, const CostEstimate& f, int ranks,
                                      const std::optional<Link>& link = std::nullopt,
                                      const std::vector<scene::SolverKind>& kinds = sim::registry());
std::string parallel_estimate_text(const ParallelEstimate& o, const CostEstimate& f, const scene::Scene& scene);

/// The model: a round between neighbours takes the latency, one of all as many as the logarithm of their number, and bytes their time.
ModelStep model_step(double computing, const RankTraffic& sent, int ranks, const Link& link);

}  // namespace weir::validation
