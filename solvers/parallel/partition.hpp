// Partition of planes among ranks, and the planes that a halo exchange sends. Every rank computes the same result, without communication.
#pragma once
#include <algorithm>
#include <vector>

namespace weir {

/// Partition of the planes of cells along the slowest axis: rank r owns [at[r], at[r + 1]). Empty: there is one rank.
struct Partition {
    std::vector<int> at{};

    bool empty() const { return at.empty(); }
    int ranks() const { return static_cast<int>(at.size()) - 1; }
    int planes() const { return at.back(); }
    int begin(int rank) const { return at[static_cast<std::size_t>(rank)]; }
    /// End of a rank's planes in an array of `count` planes: the last rank also owns those beyond the cells, such as the last plane of
    /// faces.
    int end(int rank, int count) const { return rank + 1 == ranks() ? count : at[static_cast<std::size_t>(rank) + 1]; }
    bool operator==(const Partition&) const = default;
};

/// Communicator as equal as multiples of 8 planes allow, so that three coarser multigrid levels have matching boundaries; multiples of less
/// where there are few planes. One rank gets no partition. There must be at least one plane per rank.
inline Partition equal_partition(int planes, int ranks) {
    Partition cut;
    if (ranks == 1) return cut;
    int unit = 8;
    while (unit > 1 && planes / unit < ranks) unit /= 2;
    const int units = planes / unit;
    for (int r = 0; r < ranks; ++r) cut.at.push_back(static_cast<int>(static_cast<long>(units) * r / ranks) * unit);
    cut.at.push_back(planes);
    return cut;
}

/// Planes [begin, end).
struct PlaneRange {
    int begin, end;
    bool operator==(const PlaneRange&) const = default;
};

/// The planes of an array of `count` planes that rank `to` receives from rank `from` to fill `ghost_planes` planes on both sides. `ring`:
/// also around the ends of a periodic axis, where plane n of faces is plane 0.
inline std::vector<PlaneRange> halo_from(const Partition& cut, int from, int to, int count, int ghost_planes, bool ring) {
    const int n = cut.planes(), begin = cut.begin(to), end = cut.end(to, n);
    std::vector<char> wanted(static_cast<std::size_t>(count), 0);
    const auto want = [&](int plane) {
        if (plane >= 0 && plane < count) wanted[static_cast<std::size_t>(plane)] = 1;
        if (ring && (plane < 0 || plane >= n)) wanted[static_cast<std::size_t>((plane % n + n) % n)] = 1;
    };
    ghost_planes = std::min(ghost_planes, n);
    for (int k = 1; k <= ghost_planes; ++k) want(begin - k), want(end + k - 1);
    for (int plane = begin; plane < cut.end(to, count); ++plane) wanted[static_cast<std::size_t>(plane)] = 0;
    std::vector<PlaneRange> list;
    for (int plane = cut.begin(from); plane < cut.end(from, count); ++plane) {
        if (!wanted[static_cast<std::size_t>(plane)]) continue;
        if (list.empty() || list.back().end != plane) list.push_back({plane, plane});
        list.back().end = plane + 1;
    }
    return list;
}

}  // namespace weir
