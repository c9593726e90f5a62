// Columns of a lattice and the knots on them. A column's pressure is linear between knots; a knot is the centre of a lattice cell. Knots on
// consecutive rows form the uniform grid. Two knots H − 1 rows apart are the bottom and the top of a tall cell of H rows (Chentanez &
// Müller 2011); several such elements on top of each other form a stacked column.
#pragma once
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "parallel/grid.hpp"
#include "poisson/poisson.hpp"

#include <array>
#include <utility>
#include <vector>

namespace weir::tallcell {

/// Columns [begin, end), whole lines of them.
struct ColumnRange {
    int begin = 0, end = 0;
};

/// The upward axis, and the numbering of columns: along the other axes, the first of them fastest.
template <int D>
struct Layout {
    int up = 1, rows = 0;
    Extent<D> cells{};               // with the planes, that is, lines of columns, of this rank
    std::array<int, D - 1> axes{};   // the horizontal ones
    std::array<int, 2> n{1, 1};      // columns along them
    std::array<bool, 2> periodic{};  // of these axes

    Layout() = default;
    Layout(const Extent<D>& cells, int up, const std::array<bool, D>& periodic);

    int columns() const { return n[0] * n[1]; }
    /// This rank's columns: in parallel the lines in its planes, otherwise all.
    ColumnRange own() const;
    /// The line after these, whose faces on the lower side they own too; empty at a wall, or where all columns are owned.
    ColumnRange above() const;
    /// For each line, whether its columns are owned here or neighbours of such; empty where all columns are owned.
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

/// Offsets of the columns' lists in their concatenation, with an end offset behind the last known line. `known(line)`: whether its columns
/// have lists here; count(column): the length. Returns the total length.
template <int D, class Known, class Count>
int find_starts(const Layout<D>& layout, Known&& known, Count&& count, PlaneStore<int>& starts) {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    const int n = layout.n[0], lines = layout.n[1];
    starts.resize(layout.cells.own.slab, 0, at(n), lines + 1, 0);
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

/// The knots of all columns, bottom up; in parallel only those of this rank's columns and their neighbours.
struct Knots {
    PlaneStore<int> start;  // per column (find_starts)
    std::vector<int> row;
    std::vector<int> length;  // rows to the next knot, if all cells between are liquid; otherwise 0
    int count() const { return static_cast<int>(row.size()); }
    std::size_t bytes() const { return start.bytes() + (row.capacity() + length.capacity()) * sizeof(int); }
};

/// Walks up a column and finds the element of a row.
class Cursor {
public:
    Cursor(const Knots& knots, int column) : knots_(knots), k_(knots.start[at(column)]), end_(knots.start[at(column) + 1]) {}
    bool empty() const { return k_ == end_; }
    int first_row() const { return knots_.row[at(k_)]; }
    int last_row() const { return knots_.row[at(end_ - 1)]; }
    /// Moves up to a row; returns whether it is liquid.
    bool move_to(int row) {
        while (k_ + 1 < end_ && knots_.row[at(k_ + 1)] <= row) ++k_;
        if (k_ == end_ || knots_.row[at(k_)] > row) return false;
        return row == knots_.row[at(k_)] || row < knots_.row[at(k_)] + length();
    }
    int knot() const { return k_; }
    int length() const { return knots_.length[at(k_)]; }
    /// The row of the knot above, within an element.
    int next_row() const { return knots_.row[at(k_)] + length(); }
    /// Interpolation weight of the knot above, at a row of the element.
    real share(real row) const { return length() > 0 ? (row - knots_.row[at(k_)]) / length() : 0; }

private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    const Knots& knots_;
    int k_, end_;
};

/// Division of the deep part of a column into elements.
enum class Division {
    uniform,  // a knot in every cell
    single,   // one tall cell, as in the paper
    stacked   // elements whose length grows with depth, aligned to powers of two, so that coarser columns share their knots
};

/// Places the knots of runs of liquid cells. `deep(cell)`: whether a liquid cell may lie inside a tall cell; `depth`: number of regular
/// rows below the top of a run.
template <int D, class Deep>
void place_knots(const Layout<D>& layout, const Grid<poisson::Cell, D>& cells, Division division, int depth, Deep&& deep, Knots& knots);

/// Rows of the knots that divide [bottom, top], inclusive, below a surface at row `surface`; upwards. Returns their number, at most 64.
int divide(Division division, int bottom, int top, int surface, std::array<int, 64>& rows);

}  // namespace weir::tallcell

#include "tallcell/place_knots.hpp"
