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

template <int D>
void add_solid_flow(const MacState<D>& s, const std::array<Boundary<D>, D>& mirrored, PaddedVelocity<D>& flow) {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto is_passage = [&](int end) { return s.sides.open(a, end) || s.sides.side(a, end).kind == geometry::SideKind::inflow; };
        const bool lower = is_passage(0), upper = is_passage(1);
        for_each_cell(s.u[a].extent(), [&](const Index<D>& I) {
            if ((lower && I[a] == 0) || (upper && I[a] == s.u.cells[a])) return;
            flow[a](I) += (1 - s.solid.open[at](I)) * s.solid.velocity[at](I);
        });
        fill_ghosts(flow[a], mirrored[at]);
    }
}

#define WEIR_INSTANTIATE(D)          \
    template class VisibleLiquid<D>; \
    template void add_solid_flow<D>(const MacState<D>&, const std::array<Boundary<D>, D>&, PaddedVelocity<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
