// The geometric hierarchy: a coarse cell is fluid if any child is; restriction sums, prolongation is constant; a coarse face weighs half
// the sum of its fine faces. The half is the over-correction that constant prolongation needs (Braess 1995): a face between cells of
// double width conducts half as much as the sum says.
#pragma once
#include "poisson/level.hpp"
#include "poisson/natural.hpp"
#include "poisson/sparse_cholesky.hpp"

namespace weir::poisson {

template <int D>
class Hierarchy {
public:
    /// False, with nothing built, if the shape does not suit: an odd periodic axis cannot be coloured red and black.
    bool build(const Natural<D>& problem);
    std::vector<Level<D>>& levels() { return levels_; }
    Level<D>& finest() { return levels_.front(); }
    /// Cuts the large ones as the finest is cut, or none.
    static void cut_levels(std::vector<Level<D>>& levels, const Cut& cut);
    /// Cuts the large levels as the finest is cut, or none; answers whether the finest is.
    bool share(const Cut* cut);
    /// u = A⁻¹ r on the coarsest level.
    void solve_coarsest();
    std::size_t bytes() const;

private:
    bool plan(const Natural<D>& problem);
    void window();
    void lay_out();
    void bring_beside(std::size_t l);
    void fill(const Natural<D>& problem, std::size_t l);
    void build_coarsest();

    std::vector<Level<D>> levels_;
    Cut shared_as_{};        // what the levels' cuts follow from
    bool windowed_ = false;  // each rank holds its own planes alone of the levels that are cut
    Arena arena_;
    SparseCholesky coarsest_;
    Matrix coarsest_matrix_;
    Components coarsest_components_;
    ComponentFinder finder_;
    Vector x_, b_;
};

/// The levels of such a problem without their memory, the large ones cut as the finest is; none where the shape does not suit.
template <int D>
std::vector<Level<D>> cut_levels_of(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, const Cut& cut);

}  // namespace weir::poisson
