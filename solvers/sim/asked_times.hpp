// The times 0, every, 2 every, ... of frames and of probes.
#pragma once
#include "core/types.hpp"

#include <cstdint>

namespace weir::sim {

/// k times `every` [s]. Where `every` is a decimal fraction this is the double nearest to the decimal product: 3 times 0.1 is 0.3, the
/// number that a scene's time.end = 0.3 is, and not the 0.30000000000000004 of a rounded product.
real asked_time(real every, std::int64_t k);

/// The number of the first of these times that is later than t and differs from it by more than rounding.
std::int64_t first_after(real every, real t);

/// Times closer than this are the same time [s]: what rounding leaves of t + (T - t).
real same_time(real t);

}  // namespace weir::sim
