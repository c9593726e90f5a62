// Rows of nodes: the unit of work of the vectorised loops.
#pragma once
#include "core/grid.hpp"
#include "core/types.hpp"

#include <algorithm>

namespace weir::staggered {

inline constexpr int row_block = 128;  // points handled at once: a few kB of scratch that stays in the first-level cache

/// f(first, count) on blocks of rows covering [lo, hi), threaded over the slowest axis.
template <int D, class F>
void for_each_row(const Index<D>& lo, const Index<D>& hi, F&& f) {
    Index<D> first_column = hi;
    first_column[0] = lo[0] + 1;
    for_each_in(lo, first_column, [&](Index<D> I) {
        for (; I[0] < hi[0]; I[0] += row_block) f(I, std::min(row_block, hi[0] - I[0]));
    });
}

/// Largest |q|; NaN if any value is NaN or infinite.
template <int D>
real max_magnitude(const Grid<real, D>& q) {
    const int planes = q.extent()[D - 1];
    const std::size_t plane = planes > 0 ? q.size() / static_cast<std::size_t>(planes) : 0;
    return ordered_max(planes, [&](int k) {
        const real* values = q.data() + static_cast<std::size_t>(k) * plane;
        real largest = 0, poison = 0;  // x - x is 0, or NaN where x is not finite
#pragma omp simd reduction(max : largest) reduction(+ : poison)
        for (std::size_t i = 0; i < plane; ++i) {
            largest = std::max(largest, std::abs(values[i]));
            poison += values[i] - values[i];
        }
        return largest + poison;
    });
}

}  // namespace weir::staggered
