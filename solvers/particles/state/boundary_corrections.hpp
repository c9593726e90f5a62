// Boundary corrections: number of particles that crossed walls or solids and were moved back, and the largest distance. That no particle is
// outside afterwards holds by construction; these numbers show the quality of the method.
#pragma once
#include "core/types.hpp"

#include <atomic>
#include <cstdint>

namespace weir::particles {

/// Counts are integers and the largest distance is an exact maximum, so neither depends on the order of threads.
struct BoundaryCorrections {
    std::int64_t count = 0;  // since the start
    real farthest = 0;       // [m]

    void add(std::int64_t times, real distance) {
        std::atomic_ref<std::int64_t>(count).fetch_add(times, std::memory_order_relaxed);
        std::atomic_ref<real> most(farthest);
        for (real before = most.load(std::memory_order_relaxed); distance > before;)
            if (most.compare_exchange_weak(before, distance, std::memory_order_relaxed)) break;
    }
};

/// Relative to the spacing: distance of particles from walls and solids, and the smallest correction that counts. Smaller ones are
/// rounding: single-precision positions are accurate to 6e-8 of the domain.
inline constexpr real wall_margin = 1e-3, least_correction = 1e-4;

}  // namespace weir::particles
