// Columns of a lattice and the knots on them. A column's pressure is linear between knots; a knot is the centre of a lattice cell. Knots on
// consecutive rows are the uniform grid; two knots H − 1 rows apart are the bottom and the top of a tall cell of H rows (Chentanez & Müller
// 2011); several such elements above one another are a stacked column.
#pragma once
#include "core/grid.hpp"
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "poisson/poisson.hpp"

#include <array>
#include <utility>
#include <vector>

namespace weir::tallcell {

/// Columns [begin, end), whole lines of them.
struct ColumnRange {
    int begin = 0, end = 0;
};

/// Which axis is up, and how columns are numbered: along the other axes, the first of them fastest.
template <int D>
struct Layout {
    int up = 1, rows = 0;
    Index<D> cells{};
    std::array<int, D - 1> axes{};   // the horizontal ones
    std::array<int, 2> n{1, 1};      // columns along them
    std::array<bool, 2> periodic{};  // they

    Layout() = default;
    Layout(const Index<D>& cells, int up, const std::array<bool, D>& periodic);

    int columns() const { return n[0] * n[1]; }
    /// Those that are done here: over ranks the lines in this one's planes, else all.
    ColumnRange own() const;
    /// The line beyond the last of these, whose faces on the lower side are theirs too; none at a wall, nor where all are done here.
    ColumnRange above() const;
    /// Of each line whether its columns are done here or stand beside such; none where all are done here.
    std::vector<char> near_lines() const;
    /// The lowest cell of a column.
    Index<D> foot(int column) const {
        Index<D> I{};
        I[axes[0]] = column % n[0];
        if constexpr (D == 3) I[axes[1]] = column / n[0];
        return I;
    }
    /// The column on the lower side of `column` along horizontal axis h; −1 at a side of the domain.
    int lower(int column, int h) const {
        const int stride = h == 0 ? 1 : n[0], i = h == 0 ? column % n[0] : column / n[0];
        if (i > 0) return column - stride;
        return periodic[static_cast<std::size_t>(h)] ? column + (n[static_cast<std::size_t>(h)] - 1) * stride : -1;
    }
    int upper(int column, int h) const {
        const int m = n[static_cast<std::size_t>(h)], stride = h == 0 ? 1 : n[0], i = h == 0 ? column % n[0] : column / n[0];
        if (i + 1 < m) return column + stride;
        return periodic[static_cast<std::size_t>(h)] ? column - (m - 1) * stride : -1;
    }
};

/// Lists that columns have stand one after another: where those of each begin, and behind the last of a line that is known where they end.
/// `known(line)`: whether its columns have any here; count(column): how many. Answers how many in all.
template <int D, class Known, class Count>
int find_starts(const Layout<D>& layout, Known&& known, Count&& count, PlaneStore<int>& starts) {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    const int n = layout.n[0], lines = layout.n[1];
    starts.resize(0, at(n), lines + 1, 0);
    parallel_for(0, layout.columns(), [&](int c) {
        if (known(c / n)) starts[at(c)] = count(c);
    });
    int all = 0;
    for (int line = 0; line < lines; ++line) {
        if (!known(line)) continue;
        for (int c = line * n; c < (line + 1) * n; ++c) all += std::exchange(starts[at(c)], all);
        if (line + 1 == lines || !known(line + 1)) starts[at((line + 1) * n)] = all;
    }
    return all;
}

/// The knots of all columns, bottom up; over ranks of those that are done here and of those beside them, the others have none.
struct Knots {
    PlaneStore<int> start;  // of each column (find_starts)
    std::vector<int> row;
    std::vector<int> length;  // rows to the next knot, if all cells between are liquid; else 0
    int count() const { return static_cast<int>(row.size()); }
    std::size_t bytes() const { return start.bytes() + (row.capacity() + length.capacity()) * sizeof(int); }
};

/// Goes up a column: which element holds a row.
class Cursor {
public:
    Cursor(const Knots& knots, int column) : knots_(knots), k_(knots.start[at(column)]), end_(knots.start[at(column) + 1]) {}
    bool empty() const { return k_ == end_; }
    int first_row() const { return knots_.row[at(k_)]; }
    int last_row() const { return knots_.row[at(end_ - 1)]; }
    /// Moves to a row, never down; whether it is liquid.
    bool move_to(int row) {
        while (k_ + 1 < end_ && knots_.row[at(k_ + 1)] <= row) ++k_;
        if (k_ == end_ || knots_.row[at(k_)] > row) return false;
        return row == knots_.row[at(k_)] || row < knots_.row[at(k_)] + length();
    }
    int knot() const { return k_; }
    int length() const { return knots_.length[at(k_)]; }
    /// The row of the knot above, where there is an element.
    int next_row() const { return knots_.row[at(k_)] + length(); }
    /// Weight of the knot above at a row of the element.
    real share(real row) const { return length() > 0 ? (row - knots_.row[at(k_)]) / length() : 0; }

private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    const Knots& knots_;
    int k_, end_;
};

/// How the deep part of a column is divided.
enum class Division {
    uniform,  // not at all: a knot in every cell
    single,   // one tall cell, as in the paper
    stacked   // elements whose length grows with depth, on multiples of powers of two, so that coarser columns share their knots
};

/// The knots of runs of liquid cells. `deep(cell)` says whether a liquid cell may lie inside a tall one; `depth`: rows that stay regular
/// below the top of a run.
template <int D, class Deep>
void place_knots(const Layout<D>& layout, const Grid<poisson::Cell, D>& cells, Division division, int depth, Deep&& deep, Knots& knots);

/// Rows of the knots that divide [bottom, top], both included, below a surface at row `surface`; upwards. Answers how many; at most 64.
int divide(Division division, int bottom, int top, int surface, std::array<int, 64>& rows);

}  // namespace weir::tallcell

#include "tallcell/place_knots.hpp"
