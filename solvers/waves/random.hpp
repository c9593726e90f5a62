// Random numbers from counters, without state: the wave (m, n) of a tile has the same phase for any grid resolution, machine and thread.
// The splitmix64 finaliser (Steele, Lea & Flood 2014).
#pragma once
#include "core/types.hpp"

#include <cstdint>

namespace weir::waves {

inline std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// In (0, 1): draw number `draw` of the wave (m, n).
inline real uniform(std::uint64_t seed, int m, int n, int draw) {
    const auto word = [](int i) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)); };
    const std::uint64_t wave = word(m) << 32 | word(n);
    return (static_cast<real>(mixed(mixed(mixed(seed) ^ wave) + word(draw)) >> 11) + 0.5) * 0x1p-53;
}

}  // namespace weir::waves
