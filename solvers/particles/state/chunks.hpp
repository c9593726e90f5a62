// Divides a range into as many contiguous chunks as there are threads, always in the same way: memory stays local to its thread.
#pragma once
#include "core/parallel.hpp"

#include <array>
#include <cstdint>

namespace weir::particles {

/// Begin of chunk t out of `chunks` of [0, count).
inline int chunk_begin(int count, int t, int chunks) { return static_cast<int>(static_cast<std::int64_t>(count) * t / chunks); }

/// f(t, begin, end) for every chunk t.
template <class F>
void for_chunks(int count, int chunks, F&& f) {
#pragma omp parallel for schedule(static, 1) num_threads(chunks) if (chunks > 1)
    for (int t = 0; t < chunks; ++t) f(t, chunk_begin(count, t, chunks), chunk_begin(count, t + 1, chunks));
}
template <class F>
void for_chunks(int count, F&& f) {
    for_chunks(count, threads(), f);
}

/// Up to three coordinate arrays of the same length; unused axes are null.
using Coordinates = std::array<const real*, 3>;

}  // namespace weir::particles
