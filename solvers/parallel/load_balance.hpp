// Load balancing where planes differ in work: water that fills the lower half of a tank, a valley between hills.
#pragma once
#include "parallel/communicator.hpp"
#include "parallel/partition.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace weir {

/// Partitions the planes so that their work is as even as boundaries at multiples of 8 planes allow (of fewer where there are few planes,
/// as in equal_partition). Each rank gets at least one such slab. Planes without work still belong to the slab of their owner. One rank
/// gets no partition.
inline Partition load_balanced_partition(std::span<const std::int64_t> work, int ranks) {
    const int planes = static_cast<int>(work.size());
    Partition cut = equal_partition(planes, ranks);
    if (ranks == 1) return cut;
    int unit = 8;
    while (unit > 1 && planes / unit < ranks) unit /= 2;
    const int units = planes / unit;
    std::vector<std::int64_t> before{0};  // cumulative work before each unit
    for (int u = 0; u < units; ++u) {
        before.push_back(before.back());
        for (int q = u * unit; q < (u + 1 == units ? planes : (u + 1) * unit); ++q) before.back() += work[static_cast<std::size_t>(q)];
    }
    if (before.back() == 0) return cut;
    int last = 0;
    for (int r = 1; r < ranks; ++r) {
        const double share = static_cast<double>(before.back()) * r / ranks;
        const auto off = [&](int u) { return std::abs(static_cast<double>(before[static_cast<std::size_t>(u)]) - share); };
        int best = last + 1;
        for (int u = best; u <= units - (ranks - r); ++u)
            if (off(u) < off(best)) best = u;
        cut.at[static_cast<std::size_t>(r)] = unit * best;
        last = best;
    }
    return cut;
}

/// The work of the rank that has the most.
inline std::int64_t largest_share(std::span<const std::int64_t> work, const Partition& cut) {
    std::int64_t most = 0;
    for (int r = 0; r < cut.ranks(); ++r) {
        const auto own =
            work.subspan(static_cast<std::size_t>(cut.begin(r)), static_cast<std::size_t>(cut.end(r, cut.planes()) - cut.begin(r)));
        most = std::max(most, std::accumulate(own.begin(), own.end(), std::int64_t{0}));
    }
    return most;
}

}  // namespace weir
