// Distributed storage: the owner of a plane, values from their owners, and lists that ranks send to each other.
#pragma once
#include "core/types.hpp"
#include "parallel/communicator.hpp"

#include <cstddef>
#include <numeric>
#include <vector>

namespace weir {

/// The rank that owns a plane of cells. The last plane of faces belongs to the last rank.
inline int owner_of(const Partition& cut, int plane) {
    int rank = 0;
    while (rank + 1 < cut.ranks() && plane >= cut.begin(rank + 1)) ++rank;
    return rank;
}

/// Takes each number from its owner; all ranks receive the result.
inline std::vector<real> of_owners(const std::vector<real>& own, const std::vector<int>& owners) {
    const std::vector<real> all = of_all_ranks(own);
    std::vector<real> list;
    for (std::size_t i = 0; i < owners.size(); ++i) list.push_back(all[static_cast<std::size_t>(owners[i]) * own.size() + i]);
    return list;
}

/// A list of entries for each rank.
template <class T>
using ListsOfRanks = std::vector<std::vector<T>>;

/// Personalized all-to-all: sends each rank its list and receives the lists meant for this rank; this rank's own list stays. A table of the
/// list lengths is gathered first.
template <class T>
ListsOfRanks<T> exchange_lists(ListsOfRanks<T> lists) {
    const std::size_t ranks = lists.size(), self = static_cast<std::size_t>(communicator().rank());
    std::vector<std::size_t> counts(ranks * ranks), rows(ranks + 1);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    for (std::size_t r = 0; r < ranks; ++r) counts[self * ranks + r] = lists[r].size();
    communicator().gather_parts(counts.data(), ranks * sizeof(std::size_t), rows);
    ListsOfRanks<T> received(ranks);
    std::vector<Message> messages;
    for (std::size_t r = 0; r < ranks; ++r) {
        if (r == self) continue;
        received[r].resize(counts[r * ranks + self]);
        messages.push_back(
            {static_cast<int>(r), lists[r].data(), lists[r].size() * sizeof(T), received[r].data(), received[r].size() * sizeof(T)});
    }
    communicator().exchange(messages);
    received[self] = std::move(lists[self]);
    return received;
}

}  // namespace weir
