// Moving solids among liquid and gas. The pressure makes A u + (1 − A) u_s free of divergence, u_s the solid's velocity. Liquid and
// momentum are advected with A u, whose divergence is what solids drive out of a cell. f of a cut cell is that of its open part V, so the
// liquid is Σ V f:
//
//     (V − dt ∇·(A u)) f' = V f − Σ F,      V ≥ 2 Σ|C|  where a small cell would be emptied (it then fills slower than it would)
//
// Placement knows V to second order, the sweep of a solid to first order. What a step has made of Σ V f is given back at the interface: a
// correction of volume by mixed cells near the solid (Weymouth & Yue 2010 need none, as their V is constant).
#pragma once
#include "two_phase/solids.hpp"
#include "two_phase/transport.hpp"

namespace weir::two_phase {

template <int D>
class VisibleLiquid {
public:
    /// Updates the open parts of cells; call it after solids were placed.
    void see_solids(const SolidPlacement<D>& solids, const MacState<D>& state);
    /// The part of a cell outside solids.
    real part(const Index<D>& I) const { return part_(I); }
    /// Sets room() for a step in which A u is `flow`.
    void find_room(const MacState<D>& state, const PaddedVelocity<D>& flow, real dt, const FractionGhosts<D>& ghosts);
    /// Volumes of cells outside solids at the start of a step [cells], but at least twice what may leave them in it: a small cell fills and
    /// empties slower than it would.
    const Padded<D>& room() const { return room_; }
    /// Makes f of cut cells that of their open part where a shape of liquid ends at the solid, or lies in it alone. From now on the volume
    /// of these fractions is kept.
    void start(const geometry::Shape<D>& liquid, const SolidPlacement<D>& solids, const MacState<D>& state, Grid<real, D>& f);
    /// Bounds the fractions in solids, and moves those of mixed cells so that the liquid is what it was and `entered` more [cells]: at the
    /// surface beside moving solids; where there is none, at all of it; where no surface is resolved, in all mixed cells.
    void correct(const MacState<D>& state, real entered, Grid<real, D>& f);
    /// Liquid outside solids [cells].
    real volume(const Grid<real, D>& f) const;
    /// Σ of the corrections of all steps, and that of their magnitudes [cells].
    real corrected() const { return corrected_[0]; }
    real corrections() const { return corrected_[1]; }
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const { return part_.bytes() + swept_.bytes() + gives_.bytes() + room_.bytes(); }

private:
    real give_back(const MacState<D>& state, int level, real missing, Grid<real, D>& f);
    Grid<real, D> part_;
    bool is_swept_beside(const Index<D>& I) const;
    Grid<std::uint8_t, D> swept_;  // whether the open part has changed
    Grid<real, D> gives_;          // what a cell can give or take per unit of the factor
    Padded<D> room_;               // with ghosts
    real target_ = 0;
    std::array<real, 2> corrected_{};
};

/// Faces that a solid leaves: what flows in there comes from beside them.
template <int D>
class UncoveredFaces {
public:
    /// Call it before solids are placed anew.
    void remember(const MacState<D>& state);
    /// Bounds the velocity of faces that were closed and are open by those of the solid and of the open faces beside them that are as
    /// dense. Its continuation into the solid (solids.hpp) may be a jet of gas, behind a thin solid even one of the other side.
    void settle(MacState<D>& state, const Densities& rho, const FaceFractions<D>& fractions);
    std::size_t bytes() const;

private:
    std::array<Grid<std::uint8_t, D>, D> was_closed_;
};

}  // namespace weir::two_phase
