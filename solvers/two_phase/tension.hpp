// Surface tension in balance with the pressure: du/dt = σ κ ∇f / ρ_a on faces, with the gradient and the density that the pressure has
// (Francois et al. 2006; Popinet 2009). A drop of exact curvature then stays at rest to round-off.
#pragma once
#include "two_phase/curvature.hpp"
#include "two_phase/transport.hpp"

namespace weir::two_phase {

/// κ on a face [1/m]: the mean over those of its two cells that have one; 0 where neither has.
inline real curvature_of_face(real below, real above) {
    if (below == no_curvature) return above == no_curvature ? 0 : above;
    return above == no_curvature ? below : 0.5 * (below + above);
}

/// u += dt σ κ ∇f / ρ_a on the faces between cells. `f`: fractions with a layer of ghosts.
template <int D>
void add_tension(MacState<D>& state, const Padded<D>& f, const Around<D>& around, const Grid<real, D>& kappa, const FaceFractions<D>& faces,
                 const Densities& rho, real sigma, real dt) {
    for (int a = 0; a < D; ++a) {
        Nodes<D> inner = free_faces(state.u, state.sides, a);
        if (!state.sides.periodic(a)) inner.lo[a] = 1, inner.hi[a] = state.u.cells[a];
        const real factor = dt * sigma / state.u.h[a];
        for_each_in(inner.lo, inner.hi, [&](const Index<D>& I) {
            const Index<D> below = I - e<D>(a);
            const real difference = f(I) - f(below);
            if (difference == 0) return;
            const real curvature = curvature_of_face(kappa(around(below)), kappa(I));
            state.u[a](I) += factor / rho.of(faces[static_cast<std::size_t>(a)](I)) * curvature * difference;
        });
    }
}

}  // namespace weir::two_phase
