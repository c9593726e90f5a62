// place_knots of columns.hpp.
#pragma once
#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "tallcell/columns.hpp"

namespace weir::tallcell {

/// add(row, length) for every knot of one column, upwards.
template <int D, class Deep, class Add>
void walk_column(const Layout<D>& layout, const Grid<poisson::Cell, D>& cells, Division division, int depth, Deep&& deep, int column,
                 Add&& add) {
    const std::size_t foot = cells.linear(layout.foot(column)), stride = static_cast<std::size_t>(cells.stride(layout.up));
    const auto cell = [&](int row) { return foot + static_cast<std::size_t>(row) * stride; };
    const auto liquid = [&](int row) { return row < layout.rows && cells[cell(row)] == poisson::Cell::fluid; };
    std::array<int, 64> rows;
    for (int begin = 0; begin < layout.rows;) {
        if (!liquid(begin)) {
            ++begin;
            continue;
        }
        int end = begin;
        while (liquid(end)) ++end;
        for (int row = begin; row < end;) {
            int top = row;
            if (division != Division::uniform)
                while (top < end - depth && deep(cell(top))) ++top;
            const int count = top - row > 2 ? divide(division, row, top - 1, end, rows) : 0;
            for (int i = 0; i + 1 < count; ++i)
                add(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(i) + 1] - rows[static_cast<std::size_t>(i)]);
            if (count > 0) row = rows[static_cast<std::size_t>(count) - 1];
            add(row, row + 1 < end ? 1 : 0);
            ++row;
        }
        begin = end;
    }
}

template <int D, class Deep>
void place_knots(const Layout<D>& layout, const Grid<poisson::Cell, D>& cells, Division division, int depth, Deep&& deep, Knots& knots) {
    const std::vector<char> near = layout.near_lines();
    const auto known = [&](int line) { return near.empty() || near[static_cast<std::size_t>(line)] != 0; };
    const auto count = [&](int c) {
        int found = 0;
        walk_column(layout, cells, division, depth, deep, c, [&](int, int) { ++found; });
        return found;
    };
    resize_scratch(knots.row, static_cast<std::size_t>(find_starts(layout, known, count, knots.start)));
    resize_scratch(knots.length, knots.row.size());
    parallel_for(0, layout.columns(), [&](int c) {
        if (!known(c / layout.n[0])) return;
        auto k = static_cast<std::size_t>(knots.start[static_cast<std::size_t>(c)]);
        walk_column(layout, cells, division, depth, deep, c, [&](int row, int length) {
            knots.row[k] = row;
            knots.length[k++] = length;
        });
    });
}

}  // namespace weir::tallcell
