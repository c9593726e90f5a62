// This rank's planes of a partitioned axis. The extent of every grid carries them: an array takes its storage from them, a loop its range,
// a reduction its ranks. Without a partition (one rank, or replicated work) they are all planes, and nothing is communicated.
#pragma once
#include "core/types.hpp"
#include "parallel/partition.hpp"

#include <climits>

namespace weir {

/// This rank's part of a partition, and how arrays over it are stored. Immutable: all grids of a solver point to one.
class Slab {
public:
    Slab(Partition partition, int rank, int ghost_planes, bool ring)
        : partition_(std::move(partition)), rank_(rank), ghost_planes_(ghost_planes), ring_(ring) {}
    const Partition& partition() const { return partition_; }
    int rank() const { return rank_; }
    /// The ghost planes that a new array stores on both sides of this rank's planes.
    int ghost_planes() const { return distributed_storage() ? ghost_planes_ : partition_.planes(); }
    /// Whether an array stores a part of the planes only. Otherwise it has memory for all, to be gathered where whole arrays are read.
    bool distributed_storage() const { return ghost_planes_ > 0; }
    /// Whether ghost planes are also stored around the ends of a periodic axis.
    bool ring() const { return ring_; }
    bool operator==(const Slab&) const = default;

private:
    Partition partition_;
    int rank_, ghost_planes_;
    bool ring_;
};

/// The slab of this process; nullptr for an empty partition. 0 ghost planes: arrays have memory for all planes. Equal slabs are one object,
/// kept for the life of the process.
const Slab* slab_of(const Partition& partition, int ghost_planes = 0, bool ring = false);

/// The planes that a loop covers; all by default. The first and the last rank's include those beyond the ends of the axis.
struct OwnPlanes {
    const Slab* slab = nullptr;  // nullptr: all planes, on this rank alone
    int begin = INT_MIN, end = INT_MAX;

    OwnPlanes() = default;
    explicit OwnPlanes(const Slab* of);
    /// Whether ranks share the planes: sums over them are global.
    bool distributed() const { return slab != nullptr; }
    bool distributed_storage() const { return slab != nullptr && slab->distributed_storage(); }
    /// Of a distributed range.
    const Partition& partition() const { return slab->partition(); }
    int lower(int lo) const { return lo > begin ? lo : begin; }
    int upper(int hi) const { return hi < end ? hi : end; }
    bool contains(int plane) const { return plane >= begin && plane < end; }
    /// Also this many ghost planes on both sides: redundant local work instead of communication.
    OwnPlanes wider(int planes) const {
        OwnPlanes range = *this;
        if (begin != INT_MIN) range.begin -= planes;
        if (end != INT_MAX) range.end += planes;
        return range;
    }
    /// Also the plane above the last one: the upper faces of its cells.
    OwnPlanes with_upper_faces() const {
        OwnPlanes range = *this;
        if (end != INT_MAX) ++range.end;
        return range;
    }
    /// These planes alone: of the given ones, without the range of this rank.
    static OwnPlanes only(const Slab* slab, int begin, int end) {
        OwnPlanes range;
        range.slab = slab, range.begin = begin, range.end = end;
        return range;
    }
    bool operator==(const OwnPlanes&) const = default;
};

/// The extent of a grid, or the upper corner of a box in it, with the planes of the slowest axis that this rank owns. An index alone is the
/// extent of an array that belongs to this rank alone.
template <int D>
struct Extent : Index<D> {
    OwnPlanes own{};
    Extent() : Index<D>{} {}
    explicit Extent(const Index<D>& index) : Index<D>(index) {}
    Extent(const Index<D>& index, const OwnPlanes& planes) : Index<D>(index), own(planes) {}
    Extent wider(int planes) const { return {*this, own.wider(planes)}; }
};

template <int D>
Extent<D> operator+(const Extent<D>& a, const Index<D>& b) {
    return {static_cast<const Index<D>&>(a) + b, a.own};
}
template <int D>
Extent<D> operator-(const Extent<D>& a, const Index<D>& b) {
    return {static_cast<const Index<D>&>(a) - b, a.own};
}

/// A box that every rank processes alone: replicated work.
template <int D>
Extent<D> replicated(const Index<D>& box) {
    return Extent<D>(box);
}

}  // namespace weir
