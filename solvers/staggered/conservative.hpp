// Advection in flux form on the staggered grid: central second order for momentum, which conserves momentum and, for a divergence-free
// velocity, kinetic energy (Harlow & Welch 1965; Piacsek & Williams 1970), central or TVD for cell fields (van Leer 1974).
// In time: the low-storage third-order Runge-Kutta of Wray with a projection after each stage (Spalart, Moser & Rogers 1991; Le & Moin
// 1991), so that a stage ends with     u ← u + γ dt R(u) + ζ dt R(u of the stage before),     R: all explicit rates.
#pragma once
#include "staggered/advection.hpp"
#include "staggered/ghosts.hpp"
#include "staggered/state.hpp"

#include <span>
#include <vector>

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

/// Faces whose control volume a solid cuts. The volumes that flow through its open part, w u of the cells on both sides, add up to nothing,
/// where u does not: fluxes of whole faces leave −ū∇·u, which grows. So, with the flux F_f to the neighbour N across h and the open part V,
///
///     Nₐ = −Σ_f F_f (ũ_f − uₐ)/(h V),      ũ_f: upwind, of uₐ(I) and uₐ(N).
///
/// It keeps what is uniform, beside solids that move too. Central values do no work where all neighbours are open; a closed one is not
/// met from its own side, and fed the flow. V is that of the face, or the second widest of the openings around it, if that is more: as
/// much flows through at most, and a small volume would be crossed many times in a step.
template <int D>
class CutFaces {
public:
    /// Of the planes that this rank owns.
    void find(const MacState<D>& s);
    bool found() const { return any_ && begin_ == detail::own_share.begin && end_ == detail::own_share.end; }
    /// add_momentum_flux, with these faces as they are.
    void add_momentum_flux(const MacState<D>& s, int a, real dt, Grid<real, D>& u_a);
    std::size_t bytes() const;

private:
    real rate(const MacState<D>& s, int a, const Index<D>& I) const;
    std::array<std::vector<Index<D>>, D> faces_;
    std::vector<real> values_;
    bool any_ = false;
    int begin_ = 0, end_ = 0;
};

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
