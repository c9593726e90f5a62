#include "tallcell/column_matrix.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"

#include <algorithm>

namespace weir::tallcell {

void ColumnMatrix::resize(bool everybodys) {
    rows = static_cast<int>(row.size());
    ColumnPlaces held = *this;
    if (everybodys) held.cut = {};
    resize_lines(held, state);
    for (auto* list : lists()) resize_lines(held, *list);
    const auto clear = [&](int z) {
        std::fill_n(state.data() + line(z), line_stride(), std::uint8_t{0});
        for (auto* list : lists()) std::fill_n(list->data() + line(z), line_stride(), 0.0);
    };
    for_each_line_near(*this, 1, clear);
    if (cleared_ == *this) return;
    clear(no_line);
    cleared_ = *this;
}

void ColumnMatrix::finish() {
    refill_scratch(tall, row.size(), std::uint8_t{0});
    for (std::size_t k = 0; k + 1 < row.size(); ++k)
        if (row[k + 1] > row[k] + 1) tall[k] = tall[k + 1] = 1;
    for_each_line_near(*this, 0, [&](int z) {
        wrap_line(*this, z, beside[0].data());
        wrap_line(*this, z, beside_next[0].data());
    });
    resize_scratch(looks_, row.size() * (cut.empty() ? 1 : static_cast<std::size_t>(cut.ranks())));
    Look* here = looks_.data() + (cut.empty() ? 0 : row.size() * static_cast<std::size_t>(communicator().rank()));
    parallel_for(0, rows, [&](int k) { here[k] = {look_beside(k), any_inside(k)}; });
    join_looks();
    resize_scratch(alike, row.size());
    resize_scratch(mixed, row.size());
    mixed_end = 0;
    for (std::size_t k = 0; k < row.size(); ++k) {
        alike[k] = looks_[k].alike, mixed[k] = looks_[k].inside;
        if (mixed[k]) mixed_end = std::min(static_cast<int>(k) + 2, rows);
    }
    if (mixed_end == 0) return;
    for_each_line_near(*this, 0, [&](int z) {
        for (int x = 0; x < n[0]; ++x) find_shares(x, z);
    });
}

bool ColumnMatrix::any_inside(int k) const {
    std::uint8_t any = 0;
    for (int z = own().begin; z < own().end; ++z)
        for (const int parity : {0, 1}) {
            const std::uint8_t* s = state.data() + first(z, k, parity);
            for (int i = 0; i < of_parity(parity); ++i) any |= s[i];
        }
    return (any & inside) != 0;
}

/// In parallel the first rank has at least two lines, so that every rank has a line whose lower side is not a side of the domain.
ColumnMatrix::Alike ColumnMatrix::look_beside(int k) const {
    const LineRange lines = own();
    Alike found{1, {}, {}};
    for (const std::size_t h : {0, 1}) {
        if (n[h] == 1) continue;
        const std::size_t sample = h == 0 ? at(1, lines.begin, k) : at(0, std::max(lines.begin, 1), k);
        const real w = beside[h][sample], next = beside_next[h][sample];
        found.beside[h] = w, found.beside_next[h] = next;
        for (int z = lines.begin; z < lines.end; ++z) {
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

/// In parallel combines the flags of all ranks' lines.
void ColumnMatrix::join_looks() {
    if (cut.empty()) return;
    std::vector<std::size_t> begins;
    for (int r = 0; r <= cut.ranks(); ++r) begins.push_back(static_cast<std::size_t>(r) * row.size());
    communicator().gather_parts(looks_.data(), sizeof(Look), begins);
    for (std::size_t i = row.size(); i < looks_.size(); ++i) {
        Look& all = looks_[i % row.size()];
        all.inside |= looks_[i].inside;
        if (!(all.alike == looks_[i].alike)) all.alike = {};
    }
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
    std::size_t total = state.bytes() + row.capacity() * sizeof(int) + mixed.capacity() + tall.capacity() +
                        alike.capacity() * sizeof(Alike) + looks_.capacity() * sizeof(Look);
    for (const auto* list : {&share, &vertical, &lid, &sink, &sink_next}) total += list->bytes();
    for (const std::size_t h : {0, 1}) total += beside[h].bytes() + beside_next[h].bytes();
    return total;
}

}  // namespace weir::tallcell
