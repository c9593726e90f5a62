#include "tallcell/columns.hpp"

#include <algorithm>

namespace weir::tallcell {

template <int D>
Layout<D>::Layout(const Extent<D>& cells_, int up_, const std::array<bool, D>& periodic_) : up(up_), rows(cells_[up_]), cells(cells_) {
    std::size_t h = 0;
    for (int a = 0; a < D; ++a) {
        if (a == up) continue;
        axes[h] = a;
        n[h] = cells[a];
        periodic[h++] = periodic_[static_cast<std::size_t>(a)];
    }
}

template <int D>
ColumnRange Layout<D>::own() const {
    if (!cells.own.distributed()) return {0, columns()};
    return {cells.own.lower(0) * n[0], cells.own.upper(n[1]) * n[0]};
}

template <int D>
ColumnRange Layout<D>::above() const {
    if (!cells.own.distributed()) return {};
    const int end = own().end;
    if (end < columns()) return {end, end + n[0]};
    return periodic[1] ? ColumnRange{0, n[0]} : ColumnRange{};
}

template <int D>
std::vector<char> Layout<D>::near_lines() const {
    return planes_near(cells.own.slab, n[1], 1, periodic[1]);
}

/// Tops of tall cells lie on multiples of this: smaller motions of the surface change no knot.
constexpr int top_step = 4;

int divide(Division division, int bottom, int top, int surface, std::array<int, 64>& rows) {
    top -= top % top_step;
    if (division == Division::uniform || top - bottom < 2) return 0;
    if (division == Division::single) {
        rows[0] = bottom;
        rows[1] = top;
        return 2;
    }
    // Downwards: the length of each element is about a quarter of the depth of its top; its lower end is a multiple of that power of two.
    std::size_t count = 0;
    rows[count++] = top;
    for (int row = top; row > bottom;) {
        int length = 1;
        while (8 * length <= surface - row) length *= 2;
        int next = (row - (length + 1) / 2) / length * length;
        if (next >= row) next = row - 1;
        row = next - bottom < length / 2 ? bottom : next;
        rows[count++] = row;
        if (count == rows.size() - 1 && row > bottom) rows[count++] = row = bottom;
    }
    std::reverse(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count));
    return static_cast<int>(count);
}

template struct Layout<2>;
template struct Layout<3>;

}  // namespace weir::tallcell
