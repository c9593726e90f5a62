// Cuts that give every rank as much to do, where planes are not alike: water that fills the lower half of a tank, a valley between hills.
// For the problems here; solvers cut their grids into as many planes each, and particles by their number.
#pragma once
#include "core/halo.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace weir {

/// Each rank's share of the planes' work as even as cuts at multiples of 8 planes allow (of fewer where the planes are few, as cut_of), at
/// least one such slab for each. Planes that do nothing still count as the slabs of their owner. One rank gets no cut.
inline Cut cut_by_work(std::span<const std::int64_t> work, int ranks) {
    const int planes = static_cast<int>(work.size());
    Cut cut = cut_of(planes, ranks);
    if (ranks == 1) return cut;
    int unit = 8;
    while (unit > 1 && planes / unit < ranks) unit /= 2;
    const int units = planes / unit;
    std::vector<std::int64_t> before{0};  // work before each unit
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

}  // namespace weir
