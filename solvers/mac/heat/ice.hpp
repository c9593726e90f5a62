// Drag of ice on a grid: Carman-Kozeny, −C (1 − f)²/(f³ + ε) u with f the liquid fraction, implicit and coupled with the pressure (Voller &
// Prakash 1987):
//     u = β (u* − (dt/ρ) ∇p),   β = 1 / (1 + (dt/ρ) C (1 − f)²/(f³ + ε)).
#pragma once
#include "mac/grid/state.hpp"

namespace weir::mac {

template <int D>
class Ice {
public:
    /// Sets s.mobility to β and multiplies s.u by β; k is dt C/ρ. A face uses the smaller f of its two cells.
    void apply_drag(MacState<D>& s, const Grid<real, D>& liquid, real k);
    std::size_t bytes() const;

private:
    /// Minimum and maximum over the cells of a row.
    struct Range {
        real least, most;
    };
    void find_ranges(const Grid<real, D>& liquid);
    Grid<Range, D> ranges_;
    std::array<Grid<real, D>, D> even_;  // common β of a row's faces, as in the state; negative where they differ
};

}  // namespace weir::mac
