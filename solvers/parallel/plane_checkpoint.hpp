// A grid in a checkpoint: whole, or, with distributed storage, written by each rank for its own planes. What is read is checked, because a
// file may have the right checksum and wrong content.
#pragma once
#include "core/checkpoint.hpp"
#include "parallel/grid.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>

namespace weir {

namespace detail {
/// The offset and number of the entries of this rank's planes in an array of distributed storage.
template <class T, int D>
std::array<std::size_t, 2> own_entries(const Grid<T, D>& q) {
    const Slab& slab = *q.extent().own.slab;
    const Partition& cut = slab.partition();
    const int rank = slab.rank(), begin = cut.begin(rank), end = cut.end(rank, q.extent()[D - 1]);
    const auto plane = static_cast<std::size_t>(q.stride(D - 1));
    return {static_cast<std::size_t>(begin) * plane, static_cast<std::size_t>(end - begin) * plane};
}
}  // namespace detail

template <class T, int D>
void put_planes(Checkpoint& to, const std::string& name, const Grid<T, D>& q) {
    if (!q.store().windowed()) return to.put(name, q.values());
    const auto [begin, count] = detail::own_entries(q);
    to.put_part(name, q.values().subspan(begin, count), begin, q.size());
}

/// Throws std::runtime_error naming the block if its size is wrong or a number in it is not finite.
template <class T, int D>
void get_planes(const Checkpoint& from, const std::string& name, Grid<T, D>& q) {
    std::span<T> values = q.values();
    if (q.store().windowed()) {
        const auto [begin, count] = detail::own_entries(q);
        values = values.subspan(begin, count);
        from.get_part(name, values, begin, q.size());
    } else {
        from.get(name, values);
    }
    if constexpr (std::is_same_v<T, real>) Checkpoint::require_finite(name, values);
}

/// Numbers of steps, frames or changes; all fit in a double. Throws std::runtime_error naming the block if one is negative or so large that
/// counting on overflows.
template <std::size_t N>
std::array<std::int64_t, N> get_counts(const Checkpoint& from, const std::string& name) {
    const auto counts = from.get_value<std::array<std::int64_t, N>>(name);
    for (const std::int64_t count : counts) Checkpoint::require_within(name, count, 0, std::int64_t{1} << 53);
    return counts;
}
inline std::int64_t get_count(const Checkpoint& from, const std::string& name) { return get_counts<1>(from, name)[0]; }

}  // namespace weir
