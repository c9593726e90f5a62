// Solids on the staggered grid: open fractions and normal velocities of faces, and what stands inside solids so that interpolation near
// them reads sensible values.
#pragma once
#include "geometry/solids.hpp"
#include "staggered/state.hpp"

#include <vector>

namespace weir::staggered {

/// Faces open by less than this count as closed: fractions near zero make the pressure matrix arbitrarily badly conditioned and move
/// the surface by at most this part of a cell (Ng, Min & Gibou 2009 leave the cure open; Batty et al. 2007 clamp likewise).
inline constexpr real least_open_fraction = 0.01;

/// Faces open by less than this take part in the flux, but what the pressure leaves on them says little about the liquid's velocity: it is
/// the rest of what larger faces do, over this fraction, and squeezes out at any speed. They get the continued velocity instead.
inline constexpr real least_trusted_fraction = 0.1;

template <int D>
class SolidPlacement {
public:
    SolidPlacement(geometry::Solids<D> solids, MacState<D>& state);
    bool any() const { return !solids_.empty(); }
    bool moving() const { return solids_.moving(); }
    const geometry::Solids<D>& solids() const { return solids_; }
    geometry::Solids<D>& solids() { return solids_; }

    /// Open fractions, face velocities and cell flags at time t.
    void place(MacState<D>& s, real t);
    /// u·n = u_solid·n on closed faces.
    void set_faces(MacState<D>& s) const;
    /// The solids move at other speeds than when they were placed.
    void see_velocities(const MacState<D>& s);
    /// Continues s.before one face into solids with free slip: tangentially as the flow beside, through the surface as the solid moves.
    void extend_velocity(MacState<D>& s) const;
    /// Continues a field's `before` one cell into solids: the mean of the neighbours that are not solid.
    void extend_field(const MacState<D>& s, Padded<D>& before) const;
    /// Largest |velocity| / h of a solid's face now [1/s].
    real max_rate(const MacState<D>& s) const;
    std::size_t bytes() const { return corner_.size() * sizeof(real) + extended_.capacity() * sizeof(Extended); }

private:
    struct Extended {
        int axis;
        Index<D> face;
        Vec<D> normal, velocity;  // of the solid there
        real value;
    };
    void find_extended(const MacState<D>& s);

    geometry::Solids<D> solids_;
    Grid<real, D> corner_;  // signed distance at the corners of cells
    mutable std::vector<Extended> extended_;
};

/// Force of the pressure on all solids [N; per metre of depth in 2D]: Σ p S, S the area of solid surface in each fluid cell, whose
/// components are differences of the open fractions of opposite faces.
template <int D>
Vec<D> pressure_force(const MacState<D>& s);

}  // namespace weir::staggered
