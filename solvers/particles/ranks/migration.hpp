// In parallel, particles migrate before each neighbour search: each goes to the rank that owns its present cell. It is also sent as a ghost
// particle to ranks whose passes read that cell, or the cell of one of its images. Cells are those of one process, over the box of all
// particles. The partition is kept until a rank has many more particles than its share.
#pragma once
#include "particles/ranks/particle_exchange.hpp"
#include "particles/ranks/shares.hpp"
#include "particles/state/frame.hpp"

namespace weir::particles {

/// Global data of a distributed neighbour search: the other ranks' particles, and the positions of this rank's among all.
struct Held {
    Box box;        // of all particles
    int total = 0;  // total number
    const CellCut* cut = nullptr;
    const real* place = nullptr;  // of each particle stored here: its index in the order of one process
};

class Migration {
public:
    /// Migrates. Afterwards the entries of `arrays` are this rank's own particles, followed by its ghost particles, for which only the
    /// first `read` arrays are valid. The first `dim` arrays are the coordinates that define cells. radius: of the pair search [m]. Throws
    /// NumericalFailure on all ranks where a coordinate on any rank is not finite.
    void apply(const Frame& frame, real radius, int dim, const ParticleExchange::Arrays& arrays, std::size_t read);
    Held held(const std::vector<real>& place) const { return {box_, total_, &cut_, place.data()}; }
    int own() const { return counts_.empty() ? 0 : counts_[static_cast<std::size_t>(communicator().rank())]; }
    int total() const { return total_; }
    /// Number of particles owned by lower ranks.
    int before() const;
    /// Requests a new partition in the next call if some rank exceeds its share by this fraction.
    void balance(real most);
    void recut() { cut_points_.clear(); }
    std::size_t bytes() const;

private:
    void meet(const Coordinates& x, int count);
    void find_cut(const CellGrid& grid);
    void choose_cut_points(const CellGrid& grid);
    void find_holders(const Coordinates& x, int count, const Frame& frame, real radius);
    void rearrange(const ParticleExchange::Arrays& arrays, std::size_t read);

    CellSort cells_;
    std::vector<int> cell_;  // of own particles before migration
    Box box_;
    int total_ = 0;
    std::vector<int> counts_;                      // of each rank's own particles
    std::vector<std::array<real, 3>> cut_points_;  // in the first cell of each rank except rank 0
    CellCut cut_;
    ParticleExchange exchange_;
    std::vector<int> gone_;
    std::vector<int> image_cells_;  // scratch, of one particle
};

}  // namespace weir::particles
