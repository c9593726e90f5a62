// Estimate of what a rank sends, from the partition that all ranks know (parallel/partition.hpp), message by message as Communicator counts
// them. Each solver estimates the traffic of one step of a scene. Tests compare the estimate with the counters of runs.
#pragma once
#include "parallel/communicator.hpp"

#include <initializer_list>
#include <string>
#include <vector>

namespace weir {

/// The sizes of an array that its messages depend on: bytes per plane and number of planes.
struct PlaneSize {
    std::size_t bytes;
    int count;
};

/// The properties of one step that its messages depend on.
struct StepShape {
    int iterations = 1;                   // of the solve for the pressure or the constraints
    int cells_crossed = 1;                // by the fastest flow, rounded up
    std::int64_t step = 1;                // its number: some quantities are reduced only every few steps
    double beside = 0;                    // particles that a neighbour reads, where known; 0: the mean number in these planes
    double particles = 0;                 // total number, for particle solvers
    int viscous_iterations = 1;           // of the viscosity solve, where there is one
    int viscous_coupling_iterations = 0;  // repeated coupled solves after the first
};

/// What a rank sends in a step: halo exchanges with its neighbours, and collective communication.
struct StepTraffic {
    Traffic beside{}, everywhere{};
    std::int64_t rounds = 0;             // of both kinds: number of synchronizations
    double received = 0;                 // bytes, of collective communication
    std::vector<std::string> besides{};  // keys of the scene whose messages are not counted
    Traffic all() const { return {beside.messages + everywhere.messages, beside.bytes + everywhere.bytes}; }
};

/// Sums what one rank sends.
class Tally {
public:
    /// `ring`: also around the ends of the axis.
    Tally(Partition cut, int rank, bool ring = false) : cut_(std::move(cut)), rank_(rank), ring_(ring) {}
    const Partition& cut() const { return cut_; }
    int rank() const { return rank_; }
    StepTraffic& sent() { return sent_; }

    /// Counts Communicator::refresh, `times` times: one message per peer with the planes of all arrays that the peer reads.
    void refresh(std::span<const PlaneSize> arrays, int ghost_planes, std::int64_t times = 1) {
        refresh(cut_, ring_, arrays, ghost_planes, times);
    }
    void refresh(std::initializer_list<PlaneSize> arrays, int ghost_planes, std::int64_t times = 1) {
        refresh(std::span(arrays.begin(), arrays.size()), ghost_planes, times);
    }
    /// For arrays with another partition: the levels of a multigrid.
    void refresh(const Partition& cut, bool ring, std::span<const PlaneSize> arrays, int ghost_planes, std::int64_t times) {
        for (int peer = 0; peer < cut.ranks(); ++peer) {
            if (peer == rank_) continue;
            std::int64_t bytes = 0;
            for (const PlaneSize& array : arrays)
                for (const PlaneRange& range : halo_from(cut, rank_, peer, array.count, ghost_planes, ring))
                    bytes += static_cast<std::int64_t>(array.bytes) * (range.end - range.begin);
            if (bytes > 0) add(sent_.beside, bytes, times);
        }
        sent_.rounds += times;
    }
    /// Counts Communicator::gather: an all-gather of this rank's own planes.
    void gather(const PlaneSize& array, std::int64_t times = 1) { gather(cut_, array, times); }
    void gather(const Partition& cut, const PlaneSize& array, std::int64_t times) {
        everywhere(array.bytes * static_cast<std::size_t>(cut.end(rank_, array.count) - cut.begin(rank_)), times,
                   array.bytes * static_cast<std::size_t>(array.count));
    }
    /// The same for data that are not planes (of_ranks, gather_parts, largest); `whole`: bytes of all ranks.
    void everywhere(std::size_t bytes, std::int64_t times, std::size_t whole) {
        add(sent_.everywhere, static_cast<std::int64_t>(bytes), times);
        sent_.rounds += times;
        sent_.received += static_cast<double>(whole) * static_cast<double>(times);
    }
    /// Counts Communicator::exchange: a message to one rank, where it is not empty.
    void message(std::size_t bytes, std::int64_t times = 1) {
        if (bytes > 0) add(sent_.beside, static_cast<std::int64_t>(bytes), times);
    }

private:
    static void add(Traffic& to, std::int64_t bytes, std::int64_t times) { to.messages += times, to.bytes += bytes * times; }
    Partition cut_;
    int rank_;
    bool ring_;
    StepTraffic sent_;
};

/// Messages of the time loop after each step, for any solver: whether rank 0 could write, and whether a stop was requested.
inline void tally_run(Tally& tally) { tally.everywhere(sizeof(int), 2, sizeof(int)); }

/// The cells of a scene and the rank within its partition: the arguments of the estimates.
struct RankOf {
    Partition cut{};  // empty where particles are replicated
    int rank = 0, ranks = 1;
};

}  // namespace weir
