// The geometric hierarchy: a coarse cell is fluid if any child is. Restriction sums, prolongation is constant; a coarse face has half the
// sum of its fine faces' weights. The half is the over-correction that constant prolongation needs (Braess 1995): a face between cells of
// double width conducts half of the sum.
#pragma once
#include "poisson/geometric/level.hpp"
#include "poisson/geometric/natural.hpp"
#include "poisson/matrix/sparse_cholesky.hpp"

namespace weir::poisson {

template <int D>
class Hierarchy {
public:
    /// Returns false, with nothing built, if the shape is not supported: an odd periodic axis has no red-black colouring.
    bool build(const Natural<D>& problem);
    std::vector<Level<D>>& levels() { return levels_; }
    Level<D>& finest() { return levels_.front(); }
    /// Partitions the large levels like the finest one, or none.
    static void cut_levels(std::vector<Level<D>>& levels, const Partition& cut);
    /// u = A⁻¹ r on the coarsest level.
    void solve_coarsest();
    std::size_t bytes() const;

private:
    bool plan(const Natural<D>& problem);
    void window(const Partition& cut);
    void lay_out();
    void fill_ghosts(std::size_t l);
    void fill(const Natural<D>& problem, std::size_t l);
    void build_coarsest();

    std::vector<Level<D>> levels_;
    bool windowed_ = false;  // distributed storage of the partitioned levels
    Arena arena_;
    SparseCholesky coarsest_;
    Matrix coarsest_matrix_;
    Components coarsest_components_;
    ComponentFinder finder_;
    Vector x_, b_;
};

/// The levels of such a problem without their memory, the large ones partitioned like the finest; none where the shape is not supported.
template <int D>
std::vector<Level<D>> cut_levels_of(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight,
                                    const Partition& cut);

}  // namespace weir::poisson
