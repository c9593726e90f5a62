// Rank-ordered reduction: sums of distributed terms in the order of one process. Each rank continues with the partial result of the
// previous rank.
#pragma once
#include "parallel/communicator.hpp"

namespace weir {

/// Applies go_on(value) on one rank after another, in rank order. All ranks return the last rank's result.
template <class T, class F>
T rank_ordered_reduction(T value, F&& go_on) {
    for (int rank = 0; rank < communicator().ranks(); ++rank) {
        if (rank == communicator().rank()) go_on(value);
        value = of_ranks(value)[static_cast<std::size_t>(rank)];
    }
    return value;
}

}  // namespace weir
