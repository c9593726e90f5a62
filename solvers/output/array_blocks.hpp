// A rank's part of an encoded array. Compressed data have blocks of a fixed size, independent of the partition: a block belongs to the rank
// in whose part it starts, which receives the rest of its last block from the following ranks.
#pragma once
#include "output/data_array.hpp"
#include "output/frame_format.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace weir::output {

inline constexpr std::size_t bytes_of_block = 32768;  // before compression

struct EncodedPart {
    std::vector<std::uint32_t> sizes{};  // of this rank's blocks, compressed; empty without compression
    std::string bytes{};
};

/// Collective.
EncodedPart encoded_part(const DataArray& array, Compression compression);

/// Global extremes of all elements, on rank 0; for several components of the vector magnitudes.
Extremes extremes_of(const DataArray& array);

}  // namespace weir::output
