// A grid in a checkpoint: whole, or, with distributed storage, written by each rank for its own planes.
#pragma once
#include "core/checkpoint.hpp"
#include "parallel/grid.hpp"

#include <string>

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

template <class T, int D>
void get_planes(const Checkpoint& from, const std::string& name, Grid<T, D>& q) {
    if (!q.store().windowed()) return from.get(name, q.values());
    const auto [begin, count] = detail::own_entries(q);
    from.get_part(name, q.values().subspan(begin, count), begin, q.size());
}

}  // namespace weir
