#include "two_phase/moving_solids.hpp"

#include "free_surface/level_set.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

template <int D>
void VisibleLiquid<D>::see_solids(const SolidPlacement<D>& solids, const MacState<D>& state) {
    if (part_.empty()) part_ = Grid<real, D>(state.extent());
    for_each_cell(state.extent(), [&](const Index<D>& I) { part_(I) = free_surface::open_part_of_cell(solids, I); });
}

template <int D>
void VisibleLiquid<D>::find_room(const MacState<D>& state, const PaddedVelocity<D>& flow, real dt, const FractionGhosts<D>& ghosts) {
    if (room_.empty()) room_ = Padded<D>(state.extent()), own_room_ = Grid<real, D>(state.extent());
    for_each_cell(own_room_.extent(), [&](const Index<D>& I) {
        own_room_(I) = 1;
        if (part_(I) == 1 || !is_open(state, I)) return;
        real leaving = 0, out = 0;
        for (int a = 0; a < D; ++a) {
            const real ratio = dt / state.u.h[a], lower = ratio * flow[a](I), upper = ratio * flow[a](I + e<D>(a));
            leaving += std::max(std::abs(lower), std::abs(upper)), out += upper - lower;
        }
        own_room_(I) = std::max(part_(I), std::min(1.0, 2 * leaving + std::max(out, 0.0)));
    });
    ghosts.fill_all(room_, own_room_);
}

template <int D>
real VisibleLiquid<D>::volume(const Grid<real, D>& f) const {
    return sum_over(f.extent(), [&](const Index<D>& I) { return part_(I) * f(I); });
}

/// f += λ f (1 − f) in mixed cells, |λ| ≤ 1: f stays in [0, 1]. What this cannot give back is left to the next steps.
template <int D>
void VisibleLiquid<D>::correct(const MacState<D>& state, real entered, Grid<real, D>& f) {
    target_ += entered;
    for_each_cell(f.extent(), [&](const Index<D>& I) {
        if (part_(I) < 1) f(I) = std::clamp(f(I), 0.0, 1.0);
    });
    const auto gives = [&](const Index<D>& I) { return is_open(state, I) && is_mixed(f(I)) ? f(I) * (1 - f(I)) : 0; };
    const real missing = target_ - volume(f);
    const real available = sum_over(f.extent(), [&](const Index<D>& I) { return part_(I) * gives(I); });
    if (available == 0 || missing == 0) return;
    const real factor = std::clamp(missing / available, -1.0, 1.0);
    for_each_cell(f.extent(), [&](const Index<D>& I) { f(I) += factor * gives(I); });
    corrected_[0] += factor * available, corrected_[1] += std::abs(factor * available);
}

template <int D>
void VisibleLiquid<D>::save(Checkpoint& to) const {
    to.put_value("two_phase.visible", std::array<real, 3>{target_, corrected_[0], corrected_[1]});
}

template <int D>
void VisibleLiquid<D>::restore(const Checkpoint& from) {
    const auto all = from.template get_value<std::array<real, 3>>("two_phase.visible");
    target_ = all[0], corrected_ = {all[1], all[2]};
}

template class VisibleLiquid<2>;
template class VisibleLiquid<3>;

}  // namespace weir::two_phase
