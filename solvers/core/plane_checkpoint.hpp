// A grid in a checkpoint: whole, or, over ranks that hold their own planes alone, of each rank its own.
#pragma once
#include "core/checkpoint.hpp"
#include "core/grid.hpp"

#include <string>

namespace weir {

namespace detail {
/// Of a windowed array the entries of this rank's planes: their place and their number.
template <class T, int D>
std::array<std::size_t, 2> own_entries(const Grid<T, D>& q) {
    const Cut& cut = *own_share.cut;
    const int rank = slabs().rank(), begin = cut.begin(rank), end = cut.end(rank, q.extent()[D - 1]);
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
