// Over ranks, particles change hands before each search for neighbours: each goes to the rank that owns the cell where it stands now, and
// is shown to those whose passes read that cell, or that of an image of it. Cells are those of one process, over the box of all particles.
// Cuts stay where they are until a rank has many more particles than its share.
#pragma once
#include "particles/frame.hpp"
#include "particles/hand_over.hpp"
#include "particles/shares.hpp"

namespace weir::particles {

/// What a search over ranks knows of the particles that this one does not hold, and where its own stand among all.
struct Held {
    Box box;        // of all
    int total = 0;  // so many are they
    const CellCut* cut = nullptr;
    const real* place = nullptr;  // of each that is held: its number in the order of one process
};

class Migration {
public:
    /// Takes and gives: entries of `arrays` are then of this rank's own particles, and behind these of those shown to it, of which the
    /// first `read` arrays are known. The first `dim` are the coordinates by which particles stand in cells. Pairs closer than the radius
    /// [m]. Throws NumericalFailure on all ranks where a coordinate on any is not finite.
    void apply(const Frame& frame, real radius, int dim, const HandOver::Arrays& arrays, std::size_t read);
    Held held(const std::vector<real>& place) const { return {box_, total_, &cut_, place.data()}; }
    int own() const { return counts_.empty() ? 0 : counts_[static_cast<std::size_t>(slabs().rank())]; }
    int total() const { return total_; }
    /// How many particles lower ranks own.
    int before() const;
    /// New cuts at the next call where some rank has more than its share by so much.
    void balance(real most);
    void recut() { cut_points_.clear(); }
    std::size_t bytes() const;

private:
    void meet(const Coordinates& x, int count);
    void find_cut(const CellGrid& grid);
    void choose_cut_points(const CellGrid& grid);
    void find_holders(const Coordinates& x, int count, const Frame& frame, real radius);
    void rearrange(const HandOver::Arrays& arrays, std::size_t read);

    CellSort cells_;
    std::vector<int> cell_;  // of own particles, before they go
    Box box_;
    int total_ = 0;
    std::vector<int> counts_;                      // of each rank's own
    std::vector<std::array<real, 3>> cut_points_;  // in the first cell of each rank but rank 0
    CellCut cut_;
    HandOver hands_;
    std::vector<int> gone_;
    std::vector<int> image_cells_;  // scratch, of one particle
};

}  // namespace weir::particles
