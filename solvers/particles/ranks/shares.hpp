// Partition of particles among several ranks (parallel/communicator.hpp). Cells are divided into contiguous ranges, one per rank: nearly
// slabs of the slowest axis. The passes of a range also read the cells around its first and last cells. A rank sorts its own and its ghost
// particles (migration.hpp). A single rank owns and reads everything.
#pragma once
#include "parallel/communicator.hpp"
#include "particles/threads/cell_sort.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace weir::particles {

/// Sorted entries, particles and images, [begin, end).
struct Entries {
    int begin = 0, end = 0;
    int count() const { return end - begin; }
    bool has(int k) const { return k >= begin && k < end; }
    bool operator==(const Entries&) const = default;
};

/// A periodic image: its index and its particle's index among the sorted, and its index among images.
struct Link {
    int image, particle, number;
};

/// The partition of cells: rank r owns [at[r], at[r + 1]), and reads from a plane, a row and a cell before them to as many behind.
struct CellCut {
    std::vector<int> at;
    int far = 0;

    CellCut() = default;
    CellCut(std::vector<int> cuts, const std::array<int, 3>& cells)
        : at(std::move(cuts)), far(1 + (cells[1] > 1 ? cells[0] : 0) + (cells[2] > 1 ? cells[0] * cells[1] : 0)) {}
    int ranks() const { return std::max(1, static_cast<int>(at.size()) - 1); }
    int begin(int rank) const { return at[static_cast<std::size_t>(rank)]; }
    int end(int rank) const { return at[static_cast<std::size_t>(rank) + 1]; }
    int owner(int cell) const { return static_cast<int>(std::upper_bound(at.begin() + 1, at.end() - 1, cell) - at.begin()) - 1; }
    /// [first, last), empty where it owns none.
    std::array<int, 2> read(int rank) const {
        if (begin(rank) == end(rank)) return {begin(rank), begin(rank)};
        return {std::max(0, begin(rank) - far), std::min(at.back(), end(rank) + far)};
    }
    bool reads(int rank, int cell) const { return cell >= read(rank)[0] && cell < read(rank)[1]; }
};

class Shares {
public:
    /// A single rank.
    void own_all(int count) { own_ = read_ = {0, count}; }
    /// Finds the ranges among this rank's sorted particles.
    void set(const CellCut& cut, const CellSort& cells);
    /// Finds the messages between several ranks: to each rank the particles that its passes read, and those whose images they read. Entries
    /// from the sort's `particles` on are images.
    void find_halos(const CellSort& cells, int particles, std::span<const Link> links);

    bool several() const { return cut_.ranks() > 1; }
    const Entries& own() const { return own_; }
    const Entries& read() const { return read_; }
    /// The sorted particles that this rank sends to a rank, and those that it receives.
    std::span<const int> sent_to(int rank) const { return part(sends_, send_begins_, rank); }
    std::span<const int> got_from(int rank) const { return part(gets_, get_begins_, rank); }

    /// Halo exchange: pack(k, numbers) writes the `width` numbers of a particle, unpack(k, numbers) reads those of a ghost particle. In
    /// tests with poisoned halos, spoil(k) sets stale ones to NaN.
    template <class T, class Pack, class Unpack, class Spoil>
    void exchange(int width, Pack&& pack, Unpack&& unpack, Spoil&& spoil);
    /// spoil(k) for all entries without valid values here.
    template <class Spoil>
    void poison(Spoil&& spoil) const;
    std::size_t bytes() const;

private:
    static std::span<const int> part(const std::vector<int>& list, const std::vector<std::size_t>& begins, int rank) {
        const auto r = static_cast<std::size_t>(rank);
        return std::span(list).subspan(begins[r], begins[r + 1] - begins[r]);
    }
    void list_halo(const CellSort& cells, int particles, std::span<const Link> links, int from, int to, std::vector<int>& list) const;

    std::size_t rank_ = 0;
    CellCut cut_;
    Entries own_, read_;
    int count_ = 0;                  // of sorted entries
    std::vector<int> sends_, gets_;  // rank by rank
    std::vector<std::size_t> send_begins_, get_begins_;
    std::vector<unsigned char> sent_, got_;  // message bytes
    std::vector<Message> messages_;
};

template <class T, class Pack, class Unpack, class Spoil>
void Shares::exchange(int width, Pack&& pack, Unpack&& unpack, Spoil&& spoil) {
    if (!several()) return;
    const std::size_t numbers = static_cast<std::size_t>(width), each = numbers * sizeof(T);
    sent_.resize(sends_.size() * each);
    got_.resize(gets_.size() * each);
    T* to = reinterpret_cast<T*>(sent_.data());
    for (const int k : sends_) pack(k, to), to += numbers;
    messages_.clear();
    for (int peer = 0; peer < cut_.ranks(); ++peer) {
        const auto r = static_cast<std::size_t>(peer);
        messages_.push_back({peer, sent_.data() + each * send_begins_[r], each * sent_to(peer).size(), got_.data() + each * get_begins_[r],
                             each * got_from(peer).size()});
    }
    communicator().exchange(messages_);
    const T* from = reinterpret_cast<const T*>(got_.data());
    for (const int k : gets_) unpack(k, from), from += numbers;
    if (communicator().poisons()) poison(spoil);
}

template <class Spoil>
void Shares::poison(Spoil&& spoil) const {
    std::vector<char> known(static_cast<std::size_t>(count_), 0);
    for (int k = read().begin; k < read().end; ++k) known[static_cast<std::size_t>(k)] = 1;
    for (const int k : gets_) known[static_cast<std::size_t>(k)] = 1;
    for (std::size_t k = 0; k < known.size(); ++k)
        if (!known[k]) spoil(static_cast<int>(k));
}

}  // namespace weir::particles
