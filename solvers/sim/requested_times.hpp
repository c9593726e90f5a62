// Output times 0, every, 2 every, ... of frames and probes.
#pragma once
#include "core/types.hpp"

#include <cstdint>

namespace weir::sim {

/// k times `every` [s]. For a decimal fraction `every`, the result is the double nearest to the decimal product. 3 times 0.1 is 0.3, equal
/// to a scene's time.end = 0.3, instead of the rounded product 0.30000000000000004.
real requested_time(real every, std::int64_t k);

/// The index of the first of these times that is later than t by more than rounding.
std::int64_t first_after(real every, real t);

/// Tolerance of times [s]: closer times are equal. It covers the rounding of t + (T - t).
real same_time(real t);

}  // namespace weir::sim
