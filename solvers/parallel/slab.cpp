#include "parallel/slab.hpp"

#include "parallel/communicator.hpp"

#include <algorithm>
#include <deque>
#include <mutex>

namespace weir {

const Slab* slab_of(const Partition& partition, int ghost_planes, bool ring) {
    static std::deque<Slab> slabs;
    static std::mutex one_at_a_time;
    if (partition.empty()) return nullptr;
    const Slab slab(partition, communicator().rank(), ghost_planes, ring);
    const std::lock_guard lock(one_at_a_time);
    const auto known = std::find(slabs.begin(), slabs.end(), slab);
    return known != slabs.end() ? &*known : &slabs.emplace_back(slab);
}

OwnPlanes::OwnPlanes(const Slab* of) : slab(of) {
    if (slab == nullptr) return;
    const Partition& cut = slab->partition();
    if (slab->rank() > 0) begin = cut.begin(slab->rank());
    if (slab->rank() + 1 < cut.ranks()) end = cut.end(slab->rank(), cut.planes());
}

}  // namespace weir
