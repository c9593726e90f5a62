// What walls and solids had to correct: how often a particle that would have come through was put back, and from how far. That none is
// outside afterwards holds by construction and says nothing of the method; this does.
#pragma once
#include "core/types.hpp"

#include <atomic>
#include <cstdint>

namespace weir::particles {

/// Counts are of whole numbers and the largest distance is an exact maximum, so neither depends on the order in which threads meet.
struct Clamps {
    std::int64_t count = 0;  // since the start
    real farthest = 0;       // [m]

    void add(std::int64_t times, real distance) {
        std::atomic_ref<std::int64_t>(count).fetch_add(times, std::memory_order_relaxed);
        std::atomic_ref<real> most(farthest);
        for (real before = most.load(std::memory_order_relaxed); distance > before;)
            if (most.compare_exchange_weak(before, distance, std::memory_order_relaxed)) break;
    }
};

/// A particle is kept this part of a spacing from walls and solids, and a correction of less than that second part is rounding: positions
/// in single precision know a place to 6e-8 of the domain.
inline constexpr real wall_margin = 1e-3, least_clamp = 1e-4;

}  // namespace weir::particles
