// Ranks of this machine without MPI: forked processes that exchange through sockets between each two. For counting what a scene's ranks
// send before it runs in parallel, and for tests.
#pragma once
#include "parallel/communicator.hpp"

#include <functional>
#include <string>
#include <vector>

namespace weir {

/// What a rank has sent: to its neighbours (halo exchanges and lists), and in collective communication.
struct RankTraffic {
    Traffic beside{}, everywhere{};
    std::int64_t rounds = 0;  // of both kinds: number of synchronizations
    double received = 0;      // bytes, of collective communication
    Traffic all() const { return {beside.messages + everywhere.messages, beside.bytes + everywhere.bytes}; }
    RankTraffic since(const RankTraffic& before) const;
};

class ForkedRanks final : public Communicator {
public:
    /// sockets: one to each rank; −1 for this one.
    ForkedRanks(int rank, std::vector<int> sockets, bool poisons);
    ~ForkedRanks() override;

    void refresh(const Partition& cut, std::span<const Planes> arrays, int ghost_planes, bool ring) override;
    void gather(const Partition& cut, const Planes& planes) override;
    void gather_parts(void* entries, std::size_t bytes, std::span<const std::size_t> begins) override;
    void stream_to_first(const void* own, std::size_t bytes, const std::function<void(const void*, std::size_t)>& sink) override;
    void exchange(std::span<const Message> messages) override;
    int largest(int value) override;
    bool poisons() const override { return poisons_; }
    /// Counted as the MPI communicator counts its own.
    const RankTraffic& counts() const { return counts_; }

private:
    void transfer(std::span<const Message> messages);
    void all_to_all(void* entries, std::size_t bytes, std::span<const std::size_t> begins);
    void count_beside(std::span<const Message> messages);
    void count_everywhere(std::size_t own, std::size_t all);

    std::vector<int> sockets_;
    bool poisons_;
    RankTraffic counts_;
};

/// The end of a forked rank: its exit status, 0 where body() returned, 128 + the signal that ended it; and the bytes that it returned, or
/// why it failed.
struct ForkedEnd {
    int status = 0;
    std::string said{};
};

/// body() as each of `count` ranks, each in a process of its own with one thread; an exception is told with exit status 1. A rank that
/// waits for one that has ended fails too, with status 2. `seconds`: at most; 0: without limit.
std::vector<ForkedEnd> fork_ranks(int count, const std::function<std::string(ForkedRanks&)>& body, bool poisons = false, int seconds = 0);
/// The first end that is no consequence of another's; null where no rank has failed.
const ForkedEnd* cause_of_failure(const std::vector<ForkedEnd>& ends);

}  // namespace weir
