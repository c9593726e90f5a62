// Advection in flux form on the staggered grid: central second order for momentum, which conserves momentum and, for a divergence-free
// velocity, kinetic energy (Harlow & Welch 1965; Piacsek & Williams 1970), central or TVD for cell fields (van Leer 1974).
// In time: the low-storage third-order Runge-Kutta of Wray with a projection after each stage (Spalart, Moser & Rogers 1991; Le & Moin
// 1991), so that a stage ends with     u ← u + γ dt R(u) + ζ dt R(u of the stage before),     R: all explicit rates.
#pragma once
#include "staggered/advection.hpp"
#include "staggered/ghosts.hpp"
#include "staggered/state.hpp"

#include <span>

namespace weir::staggered {

/// One stage of a step. `fraction` of dt passes in it.
struct Substep {
    real gamma = 1, zeta = 0;
    real fraction() const { return gamma + zeta; }
};
/// Cells that may be crossed in a step: the three stages are stable on the imaginary axis up to √3, and central differences stay below
/// that.
inline constexpr real runge_kutta_limit = 1.7320508075688772;
inline constexpr const char* runge_kutta_limit_why = "sqrt(3) cells, for central fluxes in three Runge-Kutta stages";

/// Three stages for `conservative`, one for schemes that follow characteristics.
std::span<const Substep> substeps(Scheme scheme);

/// u_a += dt Nₐ,  Nₐ = −Σ_b δ_b(ū_b ūₐ)  on the given faces; averages are of the two nearest values.
template <int D>
void add_momentum_flux(const PaddedVelocity<D>& before, const Vec<D>& h, const Nodes<D>& faces, real dt, Grid<real, D>& u_a);

/// q −= dt Σ_b δ_b(u_b q_b)  on all cells, q_b the value on the face; faces closed by a solid carry nothing.
template <int D>
void add_field_flux(const Padded<D>& before, const PaddedVelocity<D>& velocity, const SolidFaces<D>& solid, const Vec<D>& h, Flux flux,
                    real dt, Grid<real, D>& q);

/// q += dt q Σ_b δ_b(w_b u_b) in cells that a solid cuts, w the open part of a face: the flow out of them alone does not vanish where the
/// solid moves, since it fills or frees a part, and q is of the whole cell. So what is uniform stays so beside a solid that moves.
template <int D>
void keep_uniform_at_solids(const Padded<D>& before, const PaddedVelocity<D>& velocity, const SolidFaces<D>& solid, const Vec<D>& h,
                            real dt, Grid<real, D>& q);

/// Wray's combination for one quantity: remembers the rate of each stage for the next.
template <int D>
class StageBlend {
public:
    /// value = before + γ (value − before) + ζ (the same difference of the stage before).
    void blend(const Substep& stage, const Padded<D>& before, Grid<real, D>& value);
    std::size_t bytes() const { return increment_.bytes(); }

private:
    Grid<real, D> increment_;
};

}  // namespace weir::staggered
