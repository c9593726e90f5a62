// For a test: makes a read of a stale ghost plane visible.
#pragma once
#include "parallel/communicator.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace weir {

/// Sets to NaN every plane that this rank neither owns nor received in a halo exchange of so many ghost planes.
inline void poison_stale_ghosts(const Partition& cut, const Communicator& ranks, const Planes& planes, int ghost_planes, bool ring) {
    constexpr unsigned char byte_of_nan = 0xff;  // single or double
    std::vector<char> known(static_cast<std::size_t>(planes.count), 0);
    const auto knows = [&](int begin, int end) { std::fill(known.begin() + begin, known.begin() + end, 1); };
    knows(cut.begin(ranks.rank()), cut.end(ranks.rank(), planes.count));
    for (int peer = 0; peer < ranks.ranks(); ++peer) {
        if (peer == ranks.rank()) continue;
        for (const PlaneRange& range : halo_from(cut, peer, ranks.rank(), planes.count, ghost_planes, ring)) knows(range.begin, range.end);
    }
    for (int plane = 0; plane < planes.count; ++plane)
        if (!known[static_cast<std::size_t>(plane)] && (planes.held == nullptr || planes.held[plane] != 0))
            std::fill_n(static_cast<unsigned char*>(planes.first) + static_cast<std::ptrdiff_t>(planes.bytes) * plane, planes.bytes,
                        byte_of_nan);
}

}  // namespace weir
