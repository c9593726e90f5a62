// Rows of nodes: the unit of work of the vectorised loops.
#pragma once
#include "core/types.hpp"
#include "parallel/grid.hpp"

#include <algorithm>

namespace weir::mac {

inline constexpr int row_block = 128;  // points processed together: a few kB of scratch that stays in the first-level cache

/// The extent of an array with one entry per row, and the entry of the row of I.
template <int D>
Extent<D> rows_of(Extent<D> extent) {
    extent[0] = 1;
    return extent;
}
template <int D>
Index<D> row_of(Index<D> I) {
    I[0] = 0;
    return I;
}

/// f(first, count) on the blocks of one row, from I to the end of its axis.
template <int D, class F>
void for_each_block(Index<D> I, int end, F&& f) {
    for (; I[0] < end; I[0] += row_block) f(I, std::min(row_block, end - I[0]));
}

/// f(first, count) on blocks of rows covering [lo, hi), threaded over the slowest axis.
template <int D, class F>
void for_each_row(const Index<D>& lo, const Extent<D>& hi, F&& f) {
    Extent<D> first_column = hi;
    first_column[0] = lo[0] + 1;
    for_each_in(lo, first_column, [&](const Index<D>& I) { for_each_block(I, hi[0], f); });
}

/// The larger; NaN if either is.
inline real larger_or_nan(real a, real b) { return b > a || std::isnan(b) ? b : a; }

/// Largest |q - zero|; NaN if any value is NaN or infinite.
inline real largest_magnitude(const real* q, std::size_t count, real zero = 0) {
    real most = 0, poison = 0;  // x - x is 0, or NaN where x is not finite
#pragma omp simd reduction(max : most) reduction(+ : poison)
    for (std::size_t i = 0; i < count; ++i) {
        most = std::max(most, std::abs(q[i] - zero));
        poison += q[i] - q[i];
    }
    return most + poison;
}

/// Largest |q - zero|; NaN if any value is NaN or infinite.
template <int D>
real max_magnitude(const Grid<real, D>& q, real zero = 0) {
    const int planes = q.extent()[D - 1];
    const std::size_t plane = planes > 0 ? q.size() / static_cast<std::size_t>(planes) : 0;
    return plane_max(q.own(), planes, [&](int k) {
        const real* values = q.data() + static_cast<std::size_t>(k) * plane;
        return largest_magnitude(values, plane, zero);
    });
}

}  // namespace weir::mac
