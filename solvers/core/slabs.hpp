// One run by several processes (ranks): each owns a slab, the planes of the slowest axis between two cuts, and computes them as one process
// would. What stands beyond its cuts comes from its neighbours; sums are of the parts of planes, which are the same whoever computes them,
// added in the order of the planes. So the number of ranks changes no bit. With one rank, the default, every call does nothing.
#pragma once
#include "core/error.hpp"
#include "core/halo.hpp"

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

namespace weir {

/// The planes of an array over the slowest axis, neighbours in memory: plane 0 stands at `first`, `margin` more before it and after the
/// last.
struct Planes {
    void* first;
    std::size_t bytes;  // of a plane
    int count;
    int margin = 0;
    const char* held = nullptr;  // of each plane whether there is memory behind it; none: behind all
};

/// What goes to another rank and what comes from it; both know how much beforehand. Of 0 bytes there is no message.
struct Parcel {
    int peer;
    const void* sent;
    std::size_t sent_bytes;
    void* received;
    std::size_t received_bytes;
};

/// What this rank has sent so far.
struct Traffic {
    std::int64_t messages = 0, bytes = 0;
};

class Slabs {
public:
    Slabs() = default;
    Slabs(int rank, int ranks) : rank_(rank), ranks_(ranks) {}
    virtual ~Slabs() = default;
    Slabs(const Slabs&) = delete;
    Slabs& operator=(const Slabs&) = delete;

    int rank() const { return rank_; }
    int ranks() const { return ranks_; }
    bool several() const { return ranks_ > 1; }
    const Traffic& traffic() const { return traffic_; }

    /// Brings the `deep` planes of each array beyond both cuts of this rank from whoever owns them, in one message from each rank; `ring`:
    /// around the ends of the axis too.
    virtual void refresh(const Cut&, std::span<const Planes>, int /*deep*/, bool /*ring*/) {}
    void refresh(const Cut& cut, const Planes& planes, int deep, bool ring) { refresh(cut, std::span(&planes, 1), deep, ring); }
    /// Brings every plane that this rank does not own.
    virtual void gather(const Cut&, const Planes&) {}
    /// Everybody's bytes in the order of the ranks, to the first: sink(data, count) there, piece by piece. What it throws comes when all
    /// has been taken.
    virtual void stream_to_first(const void* own, std::size_t bytes, const std::function<void(const void*, std::size_t)>& sink) {
        sink(own, bytes);
    }
    /// The same of pieces that are no planes: rank r owns the entries [begins[r], begins[r + 1]), of `bytes` each.
    virtual void gather_parts(void* /*entries*/, std::size_t /*bytes*/, std::span<const std::size_t> /*begins*/) {}
    /// Pieces that are no planes to and from other ranks, one parcel a rank at most.
    virtual void trade(std::span<const Parcel>) {}
    /// Whether what a rank has not been brought is to be made NaN, for a test: nothing may read it.
    virtual bool poisons() const { return false; }
    /// Whether somebody looks at whole fields on all ranks, so that each is to hold them whole.
    bool holds_whole() const { return holds_whole_; }
    void hold_whole(bool yes) { holds_whole_ = yes; }
    /// Whether what is built now is of this rank alone, as in one process: to see what it takes.
    bool builds_alone() const { return builds_alone_; }
    void build_alone(bool yes) { builds_alone_ = yes; }
    /// The largest of the values that the ranks give.
    virtual int largest(int value) { return value; }
    /// Everybody's calls up to here, and whether nobody is still missing after `seconds`: where one has failed alone, the others never
    /// come.
    virtual bool all_arrive(double /*seconds*/) { return true; }
    /// Ends all ranks at once, with this exit code.
    virtual void abort(int /*exit_code*/) {}

protected:
    Traffic traffic_;

private:
    int rank_ = 0, ranks_ = 1;
    bool holds_whole_ = false, builds_alone_ = false;
};

/// Those of this process: one rank, unless set_slabs has been called.
Slabs& slabs();
/// Back to one rank with nullptr.
void set_slabs(std::unique_ptr<Slabs> several);

/// What each rank gives, in their order.
template <class T>
std::vector<T> of_ranks(const T& own) {
    std::vector<T> list(static_cast<std::size_t>(slabs().ranks()), own);
    std::vector<std::size_t> begins(list.size() + 1);
    std::iota(begins.begin(), begins.end(), std::size_t{0});
    slabs().gather_parts(list.data(), sizeof(T), begins);
    return list;
}

/// Where the lists of the ranks begin when they stand one after another, this rank's of `count` entries; and where the last one ends.
inline std::vector<std::size_t> begins_of_ranks(std::size_t count) {
    std::vector<std::size_t> begins{0};
    for (const std::size_t entries : of_ranks(count)) begins.push_back(begins.back() + entries);
    return begins;
}

/// The lists that the ranks give, one after another.
template <class T>
std::vector<T> of_all_ranks(const std::vector<T>& own) {
    const std::vector<std::size_t> begins = begins_of_ranks(own.size());
    std::vector<T> all(begins.back());
    std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(begins[static_cast<std::size_t>(slabs().rank())]));
    slabs().gather_parts(all.data(), sizeof(T), begins);
    return all;
}

/// What one rank does for all, the first: writing. One fails, all fail, with the same exit code; its own words are shown.
template <class F>
void by_first_rank(F&& f) {
    if (!slabs().several()) return f();
    std::exception_ptr failure;
    if (slabs().rank() == 0) try {
            f();
        } catch (...) {
            failure = std::current_exception();
        }
    if (slabs().largest(failure ? 1 : 0) == 0) return;
    if (failure) std::rethrow_exception(failure);
    throw OutputError("rank 0 could not write");
}

namespace detail {

/// What loops over planes do now: planes [begin, end) of cells; what lies beyond the ends of the axis belongs to its first and last plane.
struct OwnShare {
    int begin = INT_MIN, end = INT_MAX;
    const Cut* cut = nullptr;  // none: everything
    int reach = 0;             // planes beyond the cuts that ghosts are filled with
    int kept = 0;              // planes beyond the cuts that an array made now has; 0: it is whole
    bool ring = false;         // around the ends of the axis too
    int lower(int lo) const { return lo > begin ? lo : begin; }
    int upper(int hi) const { return hi < end ? hi : end; }
};
inline OwnShare own_share;

}  // namespace detail

/// While it lives, loops over planes are of this rank's own, and sums over planes are of everybody's; and arrays that are made then have
/// only these planes and `kept` beyond the cuts (core/plane_store.hpp), or all where that is 0. An empty cut changes nothing.
class OwnPlanes {
public:
    explicit OwnPlanes(const Cut& cut, int reach = 1, int kept = 0, bool ring = false);
    ~OwnPlanes() { detail::own_share = before_; }
    OwnPlanes(const OwnPlanes&) = delete;
    OwnPlanes& operator=(const OwnPlanes&) = delete;

private:
    detail::OwnShare before_;
};

/// While it lives, loops over planes are of as many planes more beyond both cuts: of what each rank finds there for itself.
class WiderPlanes {
public:
    explicit WiderPlanes(int planes) : before_(detail::own_share) {
        if (before_.begin != INT_MIN) detail::own_share.begin -= planes;
        if (before_.end != INT_MAX) detail::own_share.end += planes;
    }
    ~WiderPlanes() { detail::own_share = before_; }
    WiderPlanes(const WiderPlanes&) = delete;
    WiderPlanes& operator=(const WiderPlanes&) = delete;

private:
    detail::OwnShare before_;
};

/// While it lives, every rank does everything: the same work, with the same answer. Not `really`: nothing changes.
class AllPlanes {
public:
    explicit AllPlanes(bool really = true) : before_(detail::own_share) {
        if (really) detail::own_share = {};
    }
    ~AllPlanes() { detail::own_share = before_; }
    AllPlanes(const AllPlanes&) = delete;
    AllPlanes& operator=(const AllPlanes&) = delete;

private:
    detail::OwnShare before_;
};

/// From here on ghosts are filled this deep beyond the cuts: as far as anything moves in a step.
inline void set_reach(int planes) { detail::own_share.reach = planes; }

/// Are loops over planes those of one rank among several?
inline bool over_ranks() { return detail::own_share.cut != nullptr; }

/// Is this plane among those that loops over planes are of now?
inline bool is_own_plane(int plane) { return plane >= detail::own_share.begin && plane < detail::own_share.end; }

/// What the ranks give, added up; in one process, and where every rank does everything, what is given.
inline std::int64_t sum_of_ranks(std::int64_t own) {
    if (!over_ranks()) return own;
    const std::vector<std::int64_t> list = of_ranks(own);
    return std::accumulate(list.begin(), list.end(), std::int64_t{0});
}

}  // namespace weir
