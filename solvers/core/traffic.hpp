// What a rank sends, counted without sending it: by the arithmetic of cuts that all ranks know (core/halo.hpp), message by message as Slabs
// counts them. A solver says with it what a step of a scene sends; a forecast prints that, and tests hold the counters of runs against it.
#pragma once
#include "core/slabs.hpp"

#include <initializer_list>
#include <string>
#include <vector>

namespace weir {

/// An array as far as its messages depend on it: bytes of a plane, and how many planes there are.
struct PlaneSize {
    std::size_t bytes;
    int count;
};

/// What one step is like, as far as what is sent depends on it.
struct StepShape {
    int iterations = 1;          // of the solve for the pressure or the constraints
    int cells_crossed = 1;       // by the fastest flow, rounded up
    std::int64_t step = 1;       // its number: some things are looked at every few steps
    double beside = 0;           // particles that a neighbour reads, where that is known; 0: as many as planes hold on the mean
    double particles = 0;        // all there are, of solvers that consist of them
    int viscous_iterations = 1;  // of the solve for friction, where there is one
    int viscous_turns = 0;       // after the first
};

/// What a rank sends in a step: to those who read beside its cuts, and what everybody is to know.
struct StepTraffic {
    Traffic beside{}, everywhere{};
    std::int64_t rounds = 0;             // of either kind: how often it waits for others
    double received = 0;                 // bytes, of what everybody is to know
    std::vector<std::string> besides{};  // keys of the scene whose messages are not counted here
    Traffic all() const { return {beside.messages + everywhere.messages, beside.bytes + everywhere.bytes}; }
};

/// Adds up what one rank sends.
class Tally {
public:
    /// `ring`: around the ends of the axis too.
    Tally(Cut cut, int rank, bool ring = false) : cut_(std::move(cut)), rank_(rank), ring_(ring) {}
    const Cut& cut() const { return cut_; }
    int rank() const { return rank_; }
    StepTraffic& sent() { return sent_; }

    /// Slabs::refresh, so many times: the planes of all arrays that another rank reads go to it in one message.
    void refresh(std::span<const PlaneSize> arrays, int deep, std::int64_t times = 1) { refresh(cut_, ring_, arrays, deep, times); }
    void refresh(std::initializer_list<PlaneSize> arrays, int deep, std::int64_t times = 1) {
        refresh(std::span(arrays.begin(), arrays.size()), deep, times);
    }
    /// Of arrays that are cut elsewhere: the levels of a multigrid.
    void refresh(const Cut& cut, bool ring, std::span<const PlaneSize> arrays, int deep, std::int64_t times) {
        for (int peer = 0; peer < cut.ranks(); ++peer) {
            if (peer == rank_) continue;
            std::int64_t bytes = 0;
            for (const PlaneSize& array : arrays)
                for (const PlaneRange& range : halo_from(cut, rank_, peer, array.count, deep, ring))
                    bytes += static_cast<std::int64_t>(array.bytes) * (range.end - range.begin);
            if (bytes > 0) add(sent_.beside, bytes, times);
        }
        sent_.rounds += times;
    }
    /// Slabs::gather: this rank's own planes to all.
    void gather(const PlaneSize& array, std::int64_t times = 1) { gather(cut_, array, times); }
    void gather(const Cut& cut, const PlaneSize& array, std::int64_t times) {
        everywhere(array.bytes * static_cast<std::size_t>(cut.end(rank_, array.count) - cut.begin(rank_)), times,
                   array.bytes * static_cast<std::size_t>(array.count));
    }
    /// The same of so many bytes that are no planes (of_ranks, gather_parts, largest); `whole`: of all ranks.
    void everywhere(std::size_t bytes, std::int64_t times, std::size_t whole) {
        add(sent_.everywhere, static_cast<std::int64_t>(bytes), times);
        sent_.rounds += times;
        sent_.received += static_cast<double>(whole) * static_cast<double>(times);
    }
    /// Slabs::trade: to one rank, where there is anything.
    void parcel(std::size_t bytes, std::int64_t times = 1) {
        if (bytes > 0) add(sent_.beside, static_cast<std::int64_t>(bytes), times);
    }

private:
    static void add(Traffic& to, std::int64_t bytes, std::int64_t times) { to.messages += times, to.bytes += bytes * times; }
    Cut cut_;
    int rank_;
    bool ring_;
    StepTraffic sent_;
};

/// What the loop of a run sends after each step, whatever the solver: whether the first rank could write, and whether anybody was asked to
/// end.
inline void tally_run(Tally& tally) { tally.everywhere(sizeof(int), 2, sizeof(int)); }

/// The cells of a place among the ranks, as formulas are asked for it.
struct RankOf {
    Cut cut{};  // empty where particles are shared
    int rank = 0, ranks = 1;
};

}  // namespace weir
