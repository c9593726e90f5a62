// Particles sorted by the cell they are in: hash, sort, cell starts (Green 2010, "Particle Simulation using CUDA", section 5), with a
// counting sort on threads. Linear cell order, x fastest, so that the three x-neighbours of a cell are one contiguous run. The sort is
// stable, so the order does not depend on the number of threads.
#pragma once
#include "particles/state/chunks.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weir::particles {

/// The range of one coordinate.
struct Range {
    real lo = infinity, hi = -infinity;
    bool finite = true;
};

struct Box {
    std::array<real, 3> lo{0, 0, 0}, hi{0, 0, 0};
};

/// Cells over a box: cell (i, j, k) has index (k n_y + j) n_x + i.
struct CellGrid {
    std::array<int, 3> cells{1, 1, 1};
    std::array<real, 3> origin{0, 0, 0};
    real per_cell = 1;  // 1 / cell size
};
/// Cells of at least the width `cell_size` over the box of `count` points. Cells are wider where their number would far exceed that of the
/// points.
CellGrid cover_box(const Box& box, int count, real cell_size);

class CellSort {
public:
    /// The box of `count` points. Throws NumericalFailure when a coordinate is not finite.
    Box box(const Coordinates& x, int count);
    /// The same, and whether all are finite.
    Box box(const Coordinates& x, int count, bool& finite);
    /// Sorts `count` points into these cells, which cover them.
    void sort(const Coordinates& x, int count, const CellGrid& grid);
    /// The same where only cells [first, last) are needed: points in other cells follow, unsorted.
    void sort(const Coordinates& x, int count, const CellGrid& grid, int first, int last);
    /// Into cells at least `cell_size` wide over their box.
    void sort(const Coordinates& x, int count, real cell_size) { sort(x, count, cover_box(box(x, count), count, cell_size)); }

    /// Sorts again within each cell by before(i, j), for points that were stored in another order. Points outside the needed cells are also
    /// ordered by cell.
    template <class Before>
    void order_cells(Before&& before);

    int count() const { return count_; }
    /// Original index of each sorted particle.
    const std::vector<int>& order() const { return order_; }
    /// Cell of each sorted particle.
    const std::vector<int>& cell_of() const { return cell_; }
    /// Cell c contains sorted particles start()[c - first_cell()] .. start()[c + 1 - first_cell()] - 1.
    const std::vector<int>& start() const { return start_; }
    int first_cell() const { return first_; }
    const std::array<int, 3>& cells() const { return grid_.cells; }
    std::size_t bytes() const;
    /// Sets the cells without sorting.
    void cover(const CellGrid& grid) { grid_ = grid; }
    /// The cell of a point inside the box.
    int cell(const Coordinates& x, int i) const;
    int cell_at(const std::array<real, 3>& x) const;
    /// The cells of points 0 .. count - 1.
    void list_cells(const Coordinates& x, int count, std::vector<int>& to);

private:
    void find_cells(const Coordinates& x, int begin, int end, int* c) const;
    void place_starts(int cells, int chunks);

    int count_ = 0, first_ = 0;
    CellGrid grid_;
    std::vector<int> order_, cell_, start_;
    std::vector<int> unsorted_;                 // cell of each particle before sorting
    std::vector<std::vector<int>> histograms_;  // one per chunk; later: destination of the chunk's next particle of the cell
    std::vector<Range> ranges_;                 // scratch, one per thread
    std::vector<int> before_;                   // scratch: number of particles in the cells before each chunk's
};

template <class Before>
void CellSort::order_cells(Before&& before) {
    for_chunks(static_cast<int>(start_.size()) - 1, [&](int, int first, int last) {
        const int begin = start_[static_cast<std::size_t>(first)], end = start_[static_cast<std::size_t>(last)];
        int* const order = order_.data();
        const int* const cell = cell_.data();
        for (int k = begin + 1; k < end; ++k) {
            const int i = order[k];
            int to = k;
            for (; to > begin && cell[to - 1] == cell[k] && before(i, order[to - 1]); --to) order[to] = order[to - 1];
            order[to] = i;
        }
    });
    const auto cell = [&](int i) { return unsorted_[static_cast<std::size_t>(i)]; };
    std::sort(order_.begin() + start_.back(), order_.end(),
              [&](int i, int j) { return cell(i) != cell(j) ? cell(i) < cell(j) : before(i, j); });
    for (auto k = static_cast<std::size_t>(start_.back()); k < order_.size(); ++k) cell_[k] = cell(order_[k]);
}

}  // namespace weir::particles
