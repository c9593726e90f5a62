#include "tallcell/column_matrix.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"

#include <algorithm>

namespace weir::tallcell {

void ColumnMatrix::resize() {
    rows = static_cast<int>(row.size());
    refill_scratch(state, size(), std::uint8_t{0});
    for (auto* list : {&share, &vertical, &lid, &sink, &sink_next, &beside[0], &beside_next[0], &beside[1], &beside_next[1]})
        resize_scratch(*list, size());
    const auto zero = [&](int z) {
        const auto from = static_cast<std::ptrdiff_t>(z) * line_stride();
        for (auto* list : {&share, &vertical, &lid, &sink, &sink_next, &beside[0], &beside_next[0], &beside[1], &beside_next[1]})
            std::fill(list->begin() + from, list->begin() + from + line_stride(), 0.0);
    };
    parallel_for(0, n[1] + 1, zero);
}

void ColumnMatrix::finish() {
    refill_scratch(mixed, row.size(), std::uint8_t{0});
    refill_scratch(tall, row.size(), std::uint8_t{0});
    mixed_end = 0;
    for (std::size_t k = 0; k + 1 < row.size(); ++k)
        if (row[k + 1] > row[k] + 1) tall[k] = tall[k + 1] = 1;
    parallel_for(0, rows, [&](int k) {
        std::uint8_t any = 0;
        for (int z = 0; z < n[1]; ++z)
            for (const int parity : {0, 1}) {
                const std::uint8_t* s = state.data() + first(z, k, parity);
                for (int i = 0; i < of_parity(parity); ++i) any |= s[i];
            }
        mixed[static_cast<std::size_t>(k)] = (any & inside) != 0;
    });
    for (int k = 0; k < rows; ++k)
        if (mixed[static_cast<std::size_t>(k)]) mixed_end = std::min(k + 2, rows);
    parallel_for(0, n[1], [&](int z) {
        wrap_line(*this, z, beside[0].data());
        wrap_line(*this, z, beside_next[0].data());
    });
    find_shares();
    alike.resize(row.size());
    parallel_for(0, rows, [&](int k) { alike[static_cast<std::size_t>(k)] = look_at_row(k); });
}

ColumnMatrix::Alike ColumnMatrix::look_at_row(int k) const {
    Alike found{1, {}, {}};
    for (const std::size_t h : {0, 1}) {
        if (n[h] == 1) continue;
        const std::size_t sample = h == 0 ? at(1, 0, k) : at(0, 1, k);
        const real w = beside[h][sample], next = beside_next[h][sample];
        found.beside[h] = w, found.beside_next[h] = next;
        for (int z = 0; z < n[1]; ++z) {
            const bool side = h == 1 && z == 0 && !periodic[1];
            for (const int parity : {0, 1}) {
                const std::size_t from = first(z, k, parity);
                const int begin = h == 0 && parity == 0 && !periodic[0] ? 1 : 0;
                bool same = true;
                for (int i = begin; i < of_parity(parity); ++i) {
                    const std::size_t place = from + static_cast<std::size_t>(i);
                    same &= (side || (beside[h][place] == w && beside_next[h][place] == next));
                }
                if (!same) return {};
            }
        }
    }
    return found;
}

void ColumnMatrix::find_shares() {
    if (mixed_end == 0) return;
    parallel_for(0, n[1], [&](int z) {
        for (int x = 0; x < n[0]; ++x) find_shares(x, z);
    });
}

void ColumnMatrix::find_shares(int x, int z) {
    const auto stride = static_cast<std::size_t>(row_stride()), foot = at(x, z, 0);
    const auto is_inside = [&](int k) { return (state[foot + static_cast<std::size_t>(k) * stride] & inside) != 0; };
    const auto y = [&](int k) { return row[static_cast<std::size_t>(k)]; };
    for (int k = 0; k < mixed_end; ++k) {
        if (!is_inside(k)) continue;
        int end = k;
        while (is_inside(end)) ++end;
        const int knot = k - 1;
        for (; k < end; ++k) share[foot + static_cast<std::size_t>(k) * stride] = static_cast<real>(y(k) - y(knot)) / (y(end) - y(knot));
    }
}

std::size_t ColumnMatrix::bytes() const {
    std::size_t reals = share.capacity() + vertical.capacity() + lid.capacity() + sink.capacity() + sink_next.capacity();
    for (const std::size_t h : {0, 1}) reals += beside[h].capacity() + beside_next[h].capacity();
    return reals * sizeof(real) + row.capacity() * sizeof(int) + state.capacity() + mixed.capacity() + tall.capacity() +
           alike.capacity() * sizeof(Alike);
}

}  // namespace weir::tallcell
