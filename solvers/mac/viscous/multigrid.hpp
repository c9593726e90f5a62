// Multigrid for implicit viscosity of a staggered velocity, (m − ∇·2μD) u = b with jumps of m and μ: one V-cycle over all components at
// once, a symmetric positive definite preconditioner of conjugate gradients (Tatebe 1993; Trottenberg, Oosterlee & Schüller 2001). D
// couples the components; solved together, the coarse grids hold the rotations of a viscous body in a thin fluid, which cost no energy.
// Relaxation: the Chebyshev polynomial of degree 2 in d⁻¹ A, whose spectrum is in (0, 1] (matrix.cpp), so it needs no estimate and no order
// of the unknowns: results do not depend on the number of threads. The coarsest level is solved exactly.
#pragma once
#include "mac/viscous/level.hpp"

#include <vector>

namespace weir::mac::viscous {

template <int D>
class Multigrid {
public:
    /// `boundary`: of the components of a correction to the velocity.
    Multigrid(const Index<D>& cells, const Vec<D>& h, const std::array<Boundary<D>, D>& boundary);
    /// Returns whether there is more than one level.
    bool has_coarse_grid() const { return levels_.size() > 1; }
    /// The finest level. The caller sets `mass` on unknown faces (−1 on closed ones), `mu` in cells, `shear` at edges, and
    /// `has_closed_faces`, then calls build().
    Level<D>& finest() { return levels_.front(); }
    const Level<D>& finest() const { return levels_.front(); }
    void build();
    /// finest().other = M finest().b.
    void cycle() { cycle(0); }
    std::size_t bytes() const;

private:
    void cycle(std::size_t l);
    void relax_twice(Level<D>& level, bool from_zero);
    void factor();
    void solve_coarsest();
    template <class F>
    void for_each_coarsest(F&& f);

    std::vector<Level<D>> levels_;
    std::vector<real> factor_, solution_;  // lower triangle of the Cholesky factor by rows; empty: the coarsest level is relaxed
};

}  // namespace weir::mac::viscous
