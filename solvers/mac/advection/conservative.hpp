// Advection in flux form on the staggered grid: central second order for momentum, which conserves momentum and, for a divergence-free
// velocity, kinetic energy (Harlow & Welch 1965; Piacsek & Williams 1970), central or TVD for cell fields (van Leer 1974).
// In time: Wray's low-storage third-order Runge-Kutta with a projection after each stage (Spalart, Moser & Rogers 1991; Le & Moin 1991): a
// stage ends with     u ← u + γ dt R(u) + ζ dt R(u of the previous stage),     R: all explicit rates.
#pragma once
#include "mac/advection/advection.hpp"
#include "mac/grid/ghosts.hpp"
#include "mac/grid/state.hpp"

#include <span>
#include <vector>

namespace weir::mac {

/// One stage of a step; it advances time by `fraction` of dt.
struct Substep {
    real gamma = 1, zeta = 0;
    real fraction() const { return gamma + zeta; }
};
/// CFL limit: the three stages are stable on the imaginary axis up to √3, and central differences stay within that.
inline constexpr real runge_kutta_limit = 1.7320508075688772;
inline constexpr const char* runge_kutta_limit_why = "sqrt(3) cells, for central fluxes in three Runge-Kutta stages";

/// Three stages for `conservative`, one for semi-Lagrangian schemes.
std::span<const Substep> substeps(Scheme scheme);

/// u_a += dt Nₐ,  Nₐ = −Σ_b δ_b(ū_b ūₐ)  on the given faces; overbars are means of the two nearest values.
template <int D>
void add_momentum_flux(const PaddedVelocity<D>& before, const Vec<D>& h, const Nodes<D>& faces, real dt, Grid<real, D>& u_a);

/// Faces whose control volume is cut by a solid. The fluxes through their open parts, w u of the cells on both sides, are divergence-free,
/// but u is not: fluxes of whole faces leave −ū∇·u, which grows. So, with the flux F_f to the neighbour N at distance h and the open volume
/// fraction V,
///
///     Nₐ = −Σ_f F_f (ũ_f − uₐ)/(h V),      ũ_f: upwind, of uₐ(I) and uₐ(N).
///
/// It preserves uniform flow, also beside moving solids. Central values do no work where all neighbours are open. A closed neighbour has no
/// equation of its own, and central values would feed energy to the flow. V is that of the face, or the second widest opening around it,
/// whichever is larger. It bounds the flux through the face, and a small volume would otherwise be crossed many times per step.
template <int D>
class CutFaces {
public:
    /// Finds the cut faces in the planes that this rank owns.
    void find(const MacState<D>& s);
    bool found() const { return found_; }
    /// add_momentum_flux for these faces in their present state.
    void add_momentum_flux(const MacState<D>& s, int a, real dt, Grid<real, D>& u_a);
    std::size_t bytes() const;

private:
    real rate(const MacState<D>& s, int a, const Index<D>& I) const;
    std::array<std::vector<Index<D>>, D> faces_;
    std::vector<real> values_;
    bool found_ = false;
};

/// q −= dt Σ_b δ_b(u_b q_b)  on all cells, q_b the value on the face; faces closed by a solid have no flux.
template <int D>
void add_field_flux(const Padded<D>& before, const PaddedVelocity<D>& velocity, const SolidFaces<D>& solid, const Vec<D>& h, Flux flux,
                    real dt, Grid<real, D>& q);

/// q += dt q Σ_b δ_b(w_b u_b) in cells cut by a solid, w the open fraction of a face. Where the solid moves, the flux out of the open part
/// does not vanish, since the solid covers or uncovers a part of the cell and q belongs to the whole cell. So uniform fields stay uniform
/// beside moving solids.
template <int D>
void keep_uniform_at_solids(const Padded<D>& before, const PaddedVelocity<D>& velocity, const SolidFaces<D>& solid, const Vec<D>& h,
                            real dt, Grid<real, D>& q);

/// Wray's combination for one quantity: stores the rate of each stage for the next one.
template <int D>
class StageBlend {
public:
    /// value = before + γ (value − before) + ζ (the same difference of the previous stage).
    void blend(const Substep& stage, const Padded<D>& before, Grid<real, D>& value);
    std::size_t bytes() const { return increment_.bytes(); }

private:
    Grid<real, D> increment_;
};

}  // namespace weir::mac
