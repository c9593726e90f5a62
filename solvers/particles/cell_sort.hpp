// Particles sorted by the cell they are in: hash, sort, cell starts (Green 2010, "Particle Simulation using CUDA", section 5), with a
// counting sort on threads. Linear cell order, x fastest, so that the three x-neighbours of a cell are one contiguous run. The sort is
// stable, so the order does not depend on the number of threads.
#pragma once
#include "particles/chunks.hpp"

#include <cstdint>
#include <vector>

namespace weir::particles {

/// Of one coordinate.
struct Range {
    real lo = infinity, hi = -infinity;
    bool finite = true;
};

/// Cells over a box: cell (i, j, k) has number (k n_y + j) n_x + i.
struct CellGrid {
    std::array<int, 3> cells{1, 1, 1};
    std::array<real, 3> origin{0, 0, 0};
    real per_cell = 1;  // 1 / cell size
};
/// Cells at least `cell_size` wide over the box of `count` points. Where points are so sparse that cells would outnumber them by far, cells
/// are wider.
CellGrid cover_box(const std::array<real, 3>& lo, const std::array<real, 3>& hi, int count, real cell_size);

class CellSort {
public:
    /// Sorts `count` points into cells at least `cell_size` wide that cover their bounding box (cover_box). Throws NumericalFailure when a
    /// coordinate is not finite.
    void sort(const Coordinates& x, int count, real cell_size);

    int count() const { return count_; }
    /// Where each sorted particle came from.
    const std::vector<int>& order() const { return order_; }
    /// Cell of each sorted particle.
    const std::vector<int>& cell_of() const { return cell_; }
    /// Cell c holds sorted particles start()[c] .. start()[c + 1] - 1.
    const std::vector<int>& start() const { return start_; }
    const std::array<int, 3>& cells() const { return n_; }
    std::size_t bytes() const;
    /// The first half of sort: chooses the cells.
    void cover(const Coordinates& x, int count, real cell_size);
    /// The cell of a point that is covered.
    int cell(const Coordinates& x, int i) const;

private:
    void place_starts(int chunks);

    int count_ = 0;
    std::array<int, 3> n_{1, 1, 1};
    std::array<real, 3> origin_{0, 0, 0};
    real per_cell_ = 1;  // 1 / cell size
    std::vector<int> order_, cell_, start_;
    std::vector<int> unsorted_;                 // cell of each particle before sorting
    std::vector<std::vector<int>> histograms_;  // one a chunk; later: where the chunk's next particle of the cell goes
    std::vector<Range> ranges_;                 // scratch, one a thread
    std::vector<int> before_;                   // scratch: particles in the cells before each chunk's
};

}  // namespace weir::particles
