// Fixed solids among liquid and gas. A face has an open fraction A; liquid and momentum are advected with A u, the pressure has A ρ_l/ρ and
// ∇·(A u) (Ng, Min & Gibou 2009). Every cell with an open face has the whole volume of a cell, so small cells do not bound the step, and
// the sum of f is exact. Cells without open faces are closed: their f is not liquid of the scene but continues the surface beside them.
#pragma once
#include "mac/bodies/solid_faces.hpp"
#include "two_phase/fractions.hpp"

#include <cstdint>

namespace weir::two_phase {

/// Returns whether a cell holds fluid.
template <int D>
bool is_open(const MacState<D>& state, const Index<D>& I) {
    return state.cells(I) != poisson::Cell::solid;
}

/// Fractions of closed cells, from which the planes beside solids get their normals.
template <int D>
class ContinuedFractions {
public:
    ContinuedFractions() = default;
    ContinuedFractions(const MacState<D>& state, const Around<D>& around);
    /// Continues the planes of mixed cells straight into closed ones: two layers of them. A flat surface stays flat, whatever the shape of
    /// the solid, and no contact angle is imposed. `padded`: f with ghosts, before and after.
    void extend(const FractionGhosts<D>& ghosts, Padded<D>& padded, Grid<real, D>& f) const;
    std::size_t bytes() const;

private:
    /// A closed cell; bit k of `sources`: the k-th of its 3^D neighbours belongs to the layer before.
    struct Closed {
        Index<D> cell;
        std::uint32_t sources;
    };
    static real value(const Padded<D>& f, const Closed& closed);
    std::array<std::vector<Closed>, 2> layers_;
};

/// A u of the faces with its ghosts, from s.before, which is continued into closed faces along free-slip solids. s.u gets these values
/// there: a volume in the solid then carries the velocity of the flow beside it, not 0, into the flow.
template <int D>
void find_open_flow(MacState<D>& s, SolidPlacement<D>& solids, const std::array<Boundary<D>, D>& mirrored, PaddedVelocity<D>& flow);

}  // namespace weir::two_phase
