// (I − a ∇²) δ = r on the nodes of one kind (a velocity component or cells), by conjugate gradients: the linear solve of implicit
// viscosity and diffusion. ∇² is the 5- or 7-point Laplacian. δ is a correction: it obeys the homogeneous conditions of the sides.
#pragma once
#include "core/grid.hpp"
#include "flow/effects.hpp"
#include "staggered/ghosts.hpp"

#include <span>

namespace weir::flow {

/// What a node next to one that does not take part sees there.
enum class Beyond { value, no_flux };

/// The nodes that take part: 1, others 0, with ghosts. Empty: all do.
template <int D>
using Mask = Padded<D>;

/// out = (q(I + e_b) − 2 q(I) + q(I − e_b)) / h_b², summed over b, on `nodes`; zero where the mask is.
template <int D>
void laplacian(const Padded<D>& q, const Vec<D>& h, const Nodes<D>& nodes, const Mask<D>& mask, Beyond beyond, Grid<real, D>& out);

template <int D>
class Helmholtz {
public:
    Helmholtz(const Nodes<D>& nodes, const Vec<D>& h, const Boundary<D>& boundary, Beyond beyond, const Index<D>& extent);
    /// r on entry the right-hand side (zero outside nodes and mask), on return δ, to ‖residual‖₂ ≤ tolerance ‖r‖₂. δ = 0 in held cells.
    /// Throws NumericalFailure when that is not reached; `what` names the quantity.
    int solve(Grid<real, D>& r, real a, const Mask<D>& mask, std::span<const Held> held, const char* what);
    std::size_t bytes() const { return direction_.bytes() + image_.bytes() + solution_.bytes(); }

private:
    real dot(const Grid<real, D>& x, const Grid<real, D>& y) const;
    Nodes<D> nodes_;
    Vec<D> h_;
    Boundary<D> boundary_;
    Beyond beyond_;
    Padded<D> direction_;
    Grid<real, D> image_, solution_;
};

}  // namespace weir::flow
