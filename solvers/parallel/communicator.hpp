// One run distributed over several processes (MPI ranks). Each rank owns a slab of planes along the slowest axis and computes them as one
// process would. Ghost planes are filled by halo exchange. Sums are exact, so results are bitwise equal for any number of ranks. With one
// rank, the default, every call does nothing.
#pragma once
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "parallel/partition.hpp"
#include "parallel/slab.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

namespace weir {

/// The planes of an array along the slowest axis, contiguous in memory: plane 0 is at `first`, with `margin` more planes before it and
/// after the last.
struct Planes {
    void* first;
    std::size_t bytes;  // of a plane
    int count;
    int margin = 0;
    const char* held = nullptr;  // per plane, whether it has memory; nullptr: all have
};

/// A message sent to another rank and the one received from it; both sides know the sizes beforehand. No message is sent for 0 bytes.
struct Message {
    int peer;
    const void* sent;
    std::size_t sent_bytes;
    void* received;
    std::size_t received_bytes;
};

/// Messages and bytes that this rank has sent so far.
struct Traffic {
    std::int64_t messages = 0, bytes = 0;
};

class Communicator {
public:
    Communicator() = default;
    Communicator(int rank, int ranks) : rank_(rank), ranks_(ranks) {}
    virtual ~Communicator() = default;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;

    int rank() const { return rank_; }
    int ranks() const { return ranks_; }
    bool several() const { return ranks_ > 1; }
    const Traffic& traffic() const { return traffic_; }

    /// Halo exchange: fills `ghost_planes` planes of each array on both sides of this rank's subdomain from their owners, in one message
    /// per rank. `ring`: also around the ends of a periodic axis.
    virtual void refresh(const Partition&, std::span<const Planes>, int /*ghost_planes*/, bool /*ring*/) {}
    void refresh(const Partition& cut, const Planes& planes, int ghost_planes, bool ring) {
        refresh(cut, std::span(&planes, 1), ghost_planes, ring);
    }
    /// All-gather of planes: receives every plane that this rank does not own.
    virtual void gather(const Partition&, const Planes&) {}
    /// Streams the bytes of all ranks, in rank order, to rank 0: sink(data, count) is called there for each piece. An exception of the sink
    /// is rethrown after all data has been received.
    virtual void stream_to_first(const void* own, std::size_t bytes, const std::function<void(const void*, std::size_t)>& sink) {
        sink(own, bytes);
    }
    /// All-gather of entries that are not planes: rank r owns the entries [begins[r], begins[r + 1]), of `bytes` each.
    virtual void gather_parts(void* /*entries*/, std::size_t /*bytes*/, std::span<const std::size_t> /*begins*/) {}
    /// Point-to-point exchange of other data, at most one message per rank.
    virtual void exchange(std::span<const Message>) {}
    /// Returns whether stale (unfilled) ghosts are set to NaN, for a test: no code may read them.
    virtual bool poisons() const { return false; }
    /// Total time in which this rank slept while waiting because other processes used its processor [s].
    virtual double busy_seconds() const { return 0; }
    /// Returns whether whole fields are read on all ranks, so that each rank must store them whole.
    bool holds_whole() const { return holds_whole_; }
    void hold_whole(bool yes) { holds_whole_ = yes; }
    /// Returns whether objects built now belong to this rank alone, as in one process: to measure their memory.
    bool builds_serial() const { return builds_serial_; }
    void build_serial(bool yes) { builds_serial_ = yes; }
    /// Maximum of a value over the ranks.
    virtual int largest(int value) { return value; }
    /// Barrier with a timeout: returns false where a rank is still missing after `seconds`. A rank that failed alone never arrives.
    virtual bool all_arrive(double /*seconds*/) { return true; }
    /// Ends all ranks at once, with this exit code.
    virtual void abort(int /*exit_code*/) {}

protected:
    Traffic traffic_;

private:
    int rank_ = 0, ranks_ = 1;
    bool holds_whole_ = false, builds_serial_ = false;
};

/// The communicator of this process: one rank, unless set_communicator was called.
Communicator& communicator();
/// nullptr: back to one rank.
void set_communicator(std::unique_ptr<Communicator> several);

/// All-gather of one value per rank, in rank order.
template <class T>
std::vector<T> of_ranks(const T& own) {
    std::vector<T> list(static_cast<std::size_t>(communicator().ranks()), own);
    std::vector<std::size_t> begins(list.size() + 1);
    std::iota(begins.begin(), begins.end(), std::size_t{0});
    communicator().gather_parts(list.data(), sizeof(T), begins);
    return list;
}

/// Offsets of the ranks' lists in their concatenation, where this rank has `count` entries; the last offset is the total.
inline std::vector<std::size_t> begins_of_ranks(std::size_t count) {
    std::vector<std::size_t> begins{0};
    for (const std::size_t entries : of_ranks(count)) begins.push_back(begins.back() + entries);
    return begins;
}

/// All-gather of lists: concatenates the lists of all ranks.
template <class T>
std::vector<T> of_all_ranks(const std::vector<T>& own) {
    const std::vector<std::size_t> begins = begins_of_ranks(own.size());
    std::vector<T> all(begins.back());
    std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(begins[static_cast<std::size_t>(communicator().rank())]));
    communicator().gather_parts(all.data(), sizeof(T), begins);
    return all;
}

/// Runs f on rank 0 only: writing. If it fails, all ranks fail with the same exit code; rank 0's message is shown.
template <class F>
void by_first_rank(F&& f) {
    if (!communicator().several()) return f();
    std::exception_ptr failure;
    if (communicator().rank() == 0) try {
            f();
        } catch (...) {
            failure = std::current_exception();
        }
    if (communicator().largest(failure ? 1 : 0) == 0) return;
    if (failure) std::rethrow_exception(failure);
    throw OutputError("rank 0 could not write");
}

/// The exact sum of the terms of all ranks that share these planes: `here` is this rank's sum. An ExactSum, or ExactSums of several
/// quantities in one message.
template <class Sum>
requires std::is_class_v<Sum> Sum sum_of_ranks(const OwnPlanes& own, const Sum& here) {
    if (!own.distributed()) return here;
    Sum all{};
    for (const Sum& of_rank : of_ranks(here)) all.add(of_rank);
    return all;
}

/// The same for a list of sums, of equal length on all ranks.
template <class Sum>
void sums_of_ranks(const OwnPlanes& own, std::vector<Sum>& list) {
    if (!own.distributed() || list.empty()) return;
    const std::vector<Sum> all = of_all_ranks(list);
    const std::size_t count = list.size();
    list.assign(count, Sum{});
    for (std::size_t i = 0; i < all.size(); ++i) list[i % count].add(all[i]);
}

/// The largest value of all ranks that share these planes; NaN if any is NaN.
inline real largest_of_ranks(const OwnPlanes& own, real here) {
    if (!own.distributed()) return here;
    const std::vector<real> list = of_ranks(here);
    return detail::largest_of(list, static_cast<int>(list.size()));
}

/// Evaluates f() on the rank that owns one end of the partitioned axis and broadcasts the result.
template <class F>
auto of_rank_at(const OwnPlanes& planes, int end, F&& f) -> decltype(f()) {
    if (!planes.distributed()) return f();
    const int owner = end == 0 ? 0 : communicator().ranks() - 1;
    decltype(f()) own{};
    if (communicator().rank() == owner) own = f();
    return of_ranks(own)[static_cast<std::size_t>(owner)];
}

/// Sum of a value over the ranks that share these planes; for replicated work the value itself.
inline std::int64_t sum_of_ranks(const OwnPlanes& own, std::int64_t value) {
    if (!own.distributed()) return value;
    const std::vector<std::int64_t> list = of_ranks(value);
    return std::accumulate(list.begin(), list.end(), std::int64_t{0});
}

}  // namespace weir
