// What ice does to the flow on a grid: Carman and Kozeny's drag, −C (1 − f)²/(f³ + ε) u with f the part of melt, taken implicitly and
// together with the pressure (Voller & Prakash 1987):
//     u = β (u* − (dt/ρ) ∇p),   β = 1 / (1 + (dt/ρ) C (1 − f)²/(f³ + ε)).
#pragma once
#include "staggered/state.hpp"

namespace weir::staggered {

/// s.mobility is β and s.u becomes β u; k is dt C/ρ. A face takes the lesser f of its two cells.
template <int D>
void hold_back(MacState<D>& s, const Grid<real, D>& liquid, real k);

}  // namespace weir::staggered
