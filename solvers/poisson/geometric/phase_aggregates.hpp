// Aggregates for two phases of very different density: box × phase × component.
//
// A bubble that straddles the sides of coarse cells is 2^D strongly coupled coarse cells on every level. Its constant is then a near-null
// vector that no smoother reduces, one per bubble. Here a box of 2^D unknowns gives one aggregate per phase, and one per component of the
// lighter phase. A component whose extent is at most two coarse cells is one aggregate.
#pragma once
#include "poisson/geometric/light_components.hpp"
#include "poisson/geometric/natural.hpp"
#include "poisson/matrix/aggregation.hpp"

namespace weir::poisson {

/// The unknowns of a level: parts of boxes.
template <int D>
struct PhaseUnknowns {
    Index<D> boxes{};            // boxes along each axis
    int width = 1;               // of a box [cells], along the coarsened axes
    std::vector<int> box;        // linear index of each unknown's box; of a component that is one unknown, its first box
    std::vector<int> component;  // its light component; −1: the heavier phase
    std::size_t bytes() const { return (box.capacity() + component.capacity()) * sizeof(int); }
};

/// The cells of a problem: every fluid cell is one unknown; unknowns are numbered like the cells. Cells outside fluid have box −1.
template <int D>
PhaseUnknowns<D> unknown_cells(const Natural<D>& problem, const LightComponents& light);

/// Joins the unknowns of boxes of two along each axis of `halved`. The aggregates are numbered by colour: boxes of even and of odd index
/// sum, then whole components; a sweep in this order has no chain of dependent unknowns.
template <int D>
Aggregation join_by_phase(const PhaseUnknowns<D>& fine, const std::array<bool, D>& halved, const LightComponents& light,
                          PhaseUnknowns<D>& coarse);

}  // namespace weir::poisson
