// Whose particles are whose where several ranks run one scene (core/slabs.hpp). Sorted by cell, particles are cut into ranges of as many
// each; what the passes over a range read beside it stands between the cells around its first particle and those around its last. All ranks
// hold and sort all particles, so that each knows what every other needs. One rank owns and reads everything.
#pragma once
#include "core/slabs.hpp"
#include "particles/cell_sort.hpp"

#include <span>
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

class Shares {
public:
    /// Cuts what is sorted, between two slices of so many.
    void cut(const CellSort& cells, int slice);
    /// What travels, over several ranks: to each rank the particles that its passes read, and those whose images they read. Entries from
    /// the sort's `particles` on are images.
    void find_halos(const CellSort& cells, int particles, std::span<const Link> links);

    bool several() const { return owns_.size() > 1; }
    const Entries& own() const { return owns_[rank_]; }
    const Entries& read() const { return reads_[rank_]; }
    const Entries& own(int rank) const { return owns_[static_cast<std::size_t>(rank)]; }
    const Entries& read(int rank) const { return reads_[static_cast<std::size_t>(rank)]; }
    /// Where each rank's entries begin, and the end.
    std::span<const std::size_t> begins() const { return begins_; }
    /// The sorted particles that a rank gets from this one, and those that it sends.
    std::span<const int> sent_to(int rank) const { return part(sends_, send_begins_, rank); }
    std::span<const int> got_from(int rank) const { return part(gets_, get_begins_, rank); }

    /// Brings the halo: pack(k, numbers) writes the `width` numbers of a particle, unpack(k, numbers) takes those of another rank's, and
    /// where halos are poisoned spoil(k) makes NaN of what stayed behind.
    template <class T, class Pack, class Unpack, class Spoil>
    void trade(int width, Pack&& pack, Unpack&& unpack, Spoil&& spoil);
    /// The same of every entry that this rank does not own.
    template <class Pack, class Unpack>
    void gather(int width, Pack&& pack, Unpack&& unpack);
    /// spoil(k) for all entries of which nothing is known here.
    template <class Spoil>
    void poison(Spoil&& spoil) const;
    std::size_t bytes() const;

private:
    static std::span<const int> part(const std::vector<int>& list, const std::vector<std::size_t>& begins, int rank) {
        const auto r = static_cast<std::size_t>(rank);
        return std::span(list).subspan(begins[r], begins[r + 1] - begins[r]);
    }
    Entries reach(const CellSort& cells, const Entries& own) const;
    void list_halo(const CellSort& cells, int particles, std::span<const Link> links, int from, int to, std::vector<int>& list) const;

    std::size_t rank_ = 0;
    std::vector<Entries> owns_{1}, reads_{1};
    std::vector<std::size_t> begins_;
    std::vector<int> sends_, gets_;  // for one rank after the other
    std::vector<std::size_t> send_begins_, get_begins_;
    std::vector<unsigned char> sent_, got_;  // bytes of numbers
    std::vector<Parcel> parcels_;
    std::vector<real> all_;
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

template <class Pack, class Unpack>
void Shares::gather(int width, Pack&& pack, Unpack&& unpack) {
    if (!several()) return;
    const std::size_t numbers = static_cast<std::size_t>(width);
    const int count = owns_.back().end;
    all_.resize(static_cast<std::size_t>(count) * numbers);
    const auto at = [&](int k) { return all_.data() + static_cast<std::size_t>(k) * numbers; };
    parallel_for(own().begin, own().end, [&](int k) { pack(k, at(k)); });
    slabs().gather_parts(all_.data(), numbers * sizeof(real), begins_);
    parallel_for(0, own().begin, [&](int k) { unpack(k, at(k)); });
    parallel_for(own().end, count, [&](int k) { unpack(k, at(k)); });
}

template <class Spoil>
void Shares::poison(Spoil&& spoil) const {
    std::vector<char> known(static_cast<std::size_t>(owns_.back().end), 0);
    for (int k = read().begin; k < read().end; ++k) known[static_cast<std::size_t>(k)] = 1;
    for (const int k : gets_) known[static_cast<std::size_t>(k)] = 1;
    for (std::size_t k = 0; k < known.size(); ++k)
        if (!known[k]) spoil(static_cast<int>(k));
}

}  // namespace weir::particles
