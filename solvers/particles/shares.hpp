// Whose particles are whose where several ranks run one scene (core/slabs.hpp). Cells are cut into ranges, one a rank: nearly slabs of the
// slowest axis. What the passes over a range read beside it stands between the cells around its first and those around its last. A rank
// sorts its own particles and what others have shown it (migration.hpp). One rank owns and reads everything.
#pragma once
#include "core/slabs.hpp"
#include "particles/cell_sort.hpp"

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

/// An image beyond a side that repeats: where it and its particle stand among the sorted, and its number among images.
struct Link {
    int image, particle, number;
};

/// Which cells are whose: rank r owns [at[r], at[r + 1]), and reads from a plane, a row and a cell before them to as many behind.
struct CellCut {
    std::vector<int> at;
    int far = 0;

    CellCut() = default;
    CellCut(std::vector<int> cuts, const std::array<int, 3>& cells)
        : at(std::move(cuts)), far(1 + (cells[1] > 1 ? cells[0] : 0) + (cells[2] > 1 ? cells[0] * cells[1] : 0)) {}
    int ranks() const { return static_cast<int>(at.size()) - 1; }
    int begin(int rank) const { return at[static_cast<std::size_t>(rank)]; }
    int end(int rank) const { return at[static_cast<std::size_t>(rank) + 1]; }
    int owner(int cell) const { return static_cast<int>(std::upper_bound(at.begin() + 1, at.end() - 1, cell) - at.begin()) - 1; }
    bool reads(int rank, int cell) const { return begin(rank) < end(rank) && cell >= begin(rank) - far && cell < end(rank) + far; }
};

class Shares {
public:
    /// One rank's.
    void own_all(int count) { owns_.assign(1, {0, count}), reads_ = owns_, rank_ = 0; }
    /// Among what this rank has sorted.
    void set(const CellCut& cut, const CellSort& cells);
    /// What travels, over several ranks: to each rank the particles that its passes read, and those whose images they read. Entries from
    /// the sort's `particles` on are images.
    void find_halos(const CellSort& cells, int particles, std::span<const Link> links);

    bool several() const { return owns_.size() > 1; }
    const Entries& own() const { return owns_[rank_]; }
    const Entries& read() const { return reads_[rank_]; }
    const Entries& own(int rank) const { return owns_[static_cast<std::size_t>(rank)]; }
    const Entries& read(int rank) const { return reads_[static_cast<std::size_t>(rank)]; }
    /// The sorted particles that a rank gets from this one, and those that it sends.
    std::span<const int> sent_to(int rank) const { return part(sends_, send_begins_, rank); }
    std::span<const int> got_from(int rank) const { return part(gets_, get_begins_, rank); }

    /// Brings the halo: pack(k, numbers) writes the `width` numbers of a particle, unpack(k, numbers) takes those of another rank's, and
    /// where halos are poisoned spoil(k) makes NaN of what stayed behind.
    template <class T, class Pack, class Unpack, class Spoil>
    void trade(int width, Pack&& pack, Unpack&& unpack, Spoil&& spoil);
    /// spoil(k) for all entries of which nothing is known here.
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
    std::vector<Entries> owns_{1}, reads_{1};
    int count_ = 0;                  // of sorted entries
    std::vector<int> sends_, gets_;  // for one rank after the other
    std::vector<std::size_t> send_begins_, get_begins_;
    std::vector<unsigned char> sent_, got_;  // bytes of numbers
    std::vector<Parcel> parcels_;
};

template <class T, class Pack, class Unpack, class Spoil>
void Shares::trade(int width, Pack&& pack, Unpack&& unpack, Spoil&& spoil) {
    if (!several()) return;
    const std::size_t numbers = static_cast<std::size_t>(width), each = numbers * sizeof(T);
    sent_.resize(sends_.size() * each);
    got_.resize(gets_.size() * each);
    T* to = reinterpret_cast<T*>(sent_.data());
    for (const int k : sends_) pack(k, to), to += numbers;
    parcels_.clear();
    for (int peer = 0; peer < static_cast<int>(owns_.size()); ++peer) {
        const auto r = static_cast<std::size_t>(peer);
        parcels_.push_back({peer, sent_.data() + each * send_begins_[r], each * sent_to(peer).size(), got_.data() + each * get_begins_[r],
                            each * got_from(peer).size()});
    }
    slabs().trade(parcels_);
    const T* from = reinterpret_cast<const T*>(got_.data());
    for (const int k : gets_) unpack(k, from), from += numbers;
    if (slabs().poisons()) poison(spoil);
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
