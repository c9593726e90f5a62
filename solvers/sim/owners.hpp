// Where each rank holds its own planes alone (FieldSet::cut): what is measured comes from whoever owns the place.
#pragma once
#include "core/slabs.hpp"
#include "core/types.hpp"

#include <vector>

namespace weir::sim {

/// The rank that owns a plane of cells; of faces, the last rank the last one too.
inline int owner_of(const Cut& cut, int plane) {
    int rank = 0;
    while (rank + 1 < cut.ranks() && plane >= cut.begin(rank + 1)) ++rank;
    return rank;
}

/// Of every number the one that its owner knows, on all ranks.
inline std::vector<real> of_owners(const std::vector<real>& own, const std::vector<int>& owners) {
    const std::vector<real> all = of_all_ranks(own);
    std::vector<real> list;
    for (std::size_t i = 0; i < owners.size(); ++i) list.push_back(all[static_cast<std::size_t>(owners[i]) * own.size() + i]);
    return list;
}

}  // namespace weir::sim
