// What ice does to the flow on a grid: Carman and Kozeny's drag, −C (1 − f)²/(f³ + ε) u with f the part of melt, taken implicitly and
// together with the pressure (Voller & Prakash 1987):
//     u = β (u* − (dt/ρ) ∇p),   β = 1 / (1 + (dt/ρ) C (1 − f)²/(f³ + ε)).
#pragma once
#include "staggered/state.hpp"

namespace weir::staggered {

template <int D>
class Ice {
public:
    /// s.mobility is β and s.u becomes β u; k is dt C/ρ. A face takes the lesser f of its two cells.
    void hold_back(MacState<D>& s, const Grid<real, D>& liquid, real k);
    std::size_t bytes() const;

private:
    /// The least and the most of the cells of a row.
    struct Range {
        real least, most;
    };
    void find_ranges(const Grid<real, D>& liquid);
    Grid<Range, D> ranges_;
    std::array<Grid<real, D>, D> even_;  // β of all faces of a row, as it stands in the state; negative where they differ
};

}  // namespace weir::staggered
