// Moving solids among liquid and gas. A u + (1 − A) u_s crosses a face, u_s the solid's velocity: its divergence is zero in every cell that
// holds fluid, and f in closed cells is carried with the solid. f of a cut cell is that of its open part V, outside the solid, so the
// liquid that is visible is Σ V f. Faces and cells know the sweep of a solid to first order only. What a step has made of Σ V f is given
// back at the interface: a correction of volume by mixed cells (Weymouth & Yue 2010 need none, as their V is constant).
#pragma once
#include "two_phase/solids.hpp"

namespace weir::two_phase {

template <int D>
class VisibleLiquid {
public:
    /// Updates the open parts of cells; call it after solids were placed.
    void see_solids(const SolidPlacement<D>& solids, const MacState<D>& state);
    /// The part of a cell outside solids.
    real part(const Index<D>& I) const { return part_(I); }
    /// From now on the volume of these fractions is kept.
    void start(const Grid<real, D>& f) { target_ = volume(f); }
    /// Bounds the fractions in solids, and moves those of mixed cells so that the liquid is what it was and `entered` more [cells].
    void correct(const MacState<D>& state, real entered, Grid<real, D>& f);
    /// Liquid outside solids [cells].
    real volume(const Grid<real, D>& f) const;
    /// Σ of the corrections of all steps, and that of their magnitudes [cells].
    real corrected() const { return corrected_[0]; }
    real corrections() const { return corrected_[1]; }
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const { return part_.bytes(); }

private:
    Grid<real, D> part_;
    real target_ = 0;
    std::array<real, 2> corrected_{};
};

/// Adds (1 − A) u_s to the A u of `flow`, except on open sides and inflows, through which fluid alone passes.
template <int D>
void add_solid_flow(const MacState<D>& s, const std::array<Boundary<D>, D>& mirrored, PaddedVelocity<D>& flow);

}  // namespace weir::two_phase
