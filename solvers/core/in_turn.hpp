// Sums of terms that ranks hold in the order of one process: each goes on with what the one before it has.
#pragma once
#include "core/slabs.hpp"

namespace weir {

/// What comes of a value that each rank goes on with in turn, in their order: go_on(value). All get the last one's.
template <class T, class F>
T in_turn(T value, F&& go_on) {
    for (int rank = 0; rank < slabs().ranks(); ++rank) {
        if (rank == slabs().rank()) go_on(value);
        value = of_ranks(value)[static_cast<std::size_t>(rank)];
    }
    return value;
}

}  // namespace weir
