// A rank's part of an encoded array. Compressed data are in blocks of a fixed size, wherever ranks are cut: a block is of the rank in whose
// part it begins, which gets the rest of its last one from those behind it.
#pragma once
#include "output/data_array.hpp"
#include "output/frames.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace weir::output {

inline constexpr std::size_t bytes_of_block = 32768;  // before compression

struct EncodedPart {
    std::vector<std::uint32_t> sizes{};  // of this rank's blocks, compressed; none without compression
    std::string bytes{};
};

/// All ranks call it together.
EncodedPart encoded_part(const DataArray& array, Compression compression);

/// Of all numbers, of all ranks, as the first knows them; of several components the lengths.
Extremes extremes_of(const DataArray& array);

}  // namespace weir::output
