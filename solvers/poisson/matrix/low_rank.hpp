// A low-rank addition to a matrix: A + Σ U C Uᵀ over blocks. Rigid bodies coupled to the fluid add it to the pressure matrix (Batty,
// Bertails & Bridson 2007, eq. 9).
#pragma once
#include "core/types.hpp"

#include <array>
#include <vector>

namespace weir::poisson {

struct LowRank {
    static constexpr std::size_t columns = 6;  // maximum per block; unused ones are zero
    using Row = std::array<real, columns>;
    /// A cell with entries in a block's columns. It must be fluid, and may belong to several blocks.
    struct Entry {
        std::size_t cell;
        Row u;
    };
    /// Entries [begin, end) and the symmetric positive semidefinite C.
    struct Block {
        std::size_t begin, end;
        std::array<Row, columns> C;
    };
    std::vector<Entry> entries;
    std::vector<Block> blocks;

    void clear() { entries.clear(), blocks.clear(); }
    std::size_t bytes() const { return entries.capacity() * sizeof(Entry) + blocks.capacity() * sizeof(Block); }
};

/// C t.
inline LowRank::Row times(const std::array<LowRank::Row, LowRank::columns>& C, const LowRank::Row& t) {
    LowRank::Row sum{};
    for (std::size_t k = 0; k < LowRank::columns; ++k)
        for (std::size_t l = 0; l < LowRank::columns; ++l) sum[k] += C[k][l] * t[l];
    return sum;
}
inline real dot(const LowRank::Row& a, const LowRank::Row& b) {
    real sum = 0;
    for (std::size_t k = 0; k < LowRank::columns; ++k) sum += a[k] * b[k];
    return sum;
}

}  // namespace weir::poisson
