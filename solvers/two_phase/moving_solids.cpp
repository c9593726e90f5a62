#include "two_phase/moving_solids.hpp"

#include "free_surface/level_set.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

template <int D>
void VisibleLiquid<D>::see_solids(const SolidPlacement<D>& solids, const MacState<D>& state) {
    constexpr real round_off = 1e-9;
    const bool first = part_.empty();
    if (first) part_ = Grid<real, D>(state.extent()), swept_ = Grid<std::uint8_t, D>(state.extent());
    for_each_cell(state.extent(), [&](const Index<D>& I) {
        const real part = free_surface::open_part_of_cell(solids, I);
        swept_(I) = !first && std::abs(part - part_(I)) > round_off;
        part_(I) = part;
    });
}

template <int D>
void VisibleLiquid<D>::find_room(const MacState<D>& state, const PaddedVelocity<D>& flow, real dt, const FractionGhosts<D>& ghosts) {
    if (room_.empty()) room_ = Padded<D>(state.extent());
    for_each_cell(room_.extent(), [&](const Index<D>& I) {
        room_(I) = 1;
        if (part_(I) == 1 || !is_open(state, I)) return;
        real leaving = 0, out = 0;
        for (int a = 0; a < D; ++a) {
            const real ratio = dt / state.u.h[a], lower = ratio * flow[a](I), upper = ratio * flow[a](I + e<D>(a));
            leaving += std::max(std::abs(lower), std::abs(upper)), out += upper - lower;
        }
        room_(I) = std::max(part_(I), std::min(1.0, 2 * leaving + std::max(out, 0.0)));
    });
    ghosts.fill_outer(room_);
}

template <int D>
void VisibleLiquid<D>::start(const geometry::Shape<D>& liquid, const SolidPlacement<D>& solids, const MacState<D>& state,
                             Grid<real, D>& f) {
    constexpr int samples = D == 2 ? 8 : 4;  // along each axis
    constexpr real of_samples = 1.0 / samples;
    for_each_cell(f.extent(), [&](const Index<D>& I) {
        if (part_(I) == 0 || part_(I) == 1 || !is_mixed(f(I)) || !is_open(state, I)) return;
        int inside = 0, wet = 0;
        const Vec<D> corner = state.u.cell_centre(I) - 0.5 * state.u.h;
        for (int code = 0; code < (D == 2 ? samples * samples : samples * samples * samples); ++code) {
            Vec<D> x = corner;
            for (int a = 0, rest = code; a < D; ++a, rest /= samples) x[a] += state.u.h[a] * of_samples * (rest % samples + 0.5);
            if (solids.solids().distance(x) >= 0) continue;
            ++inside;
            if (liquid.distance(x) < 0) ++wet;
        }
        if (wet == 0)
            f(I) = std::min(1.0, f(I) / part_(I));
        else if (wet == inside && f(I) < 1 - part_(I) + of_samples * part_(I))
            f(I) = 0;
    });
    target_ = volume(f);
}

template <int D>
real VisibleLiquid<D>::volume(const Grid<real, D>& f) const {
    return sum_over(f.extent(), [&](const Index<D>& I) { return part_(I) * f(I); });
}

namespace {

/// In cells, along each axis: how far from cells whose open part has changed the surface counts as beside the solid.
constexpr int beside = 4;
enum Level { near_solids, surface, mixed_cells, levels };

/// Returns whether the cell lies between liquid and gas: films and dust do not.
template <int D>
bool is_surface(const Grid<real, D>& f, const Index<D>& I) {
    real least = 1, most = 0;
    for (int d = 0; d < D; ++d)
        for (const int way : {-1, 1}) {
            Index<D> J = I;
            J[d] += way;
            if (f.contains(J)) least = std::min(least, f(J)), most = std::max(most, f(J));
        }
    return least < 0.5 && most >= 0.5;
}

}  // namespace

template <int D>
bool VisibleLiquid<D>::is_swept_beside(const Index<D>& I) const {
    CellBox<D> box{I, I + Index<D>::constant(1)};
    bool swept = false;
    box.grown(Index<D>::constant(beside), part_.extent()).rows([&](const Index<D>& first, int count) {
        const std::uint8_t* at = &swept_(first);
        for (int i = 0; i < count && !swept; ++i) swept = at[i] != 0;
    });
    return swept;
}

/// What this cannot give back is left to the next steps.
template <int D>
void VisibleLiquid<D>::correct(const MacState<D>& state, real entered, Grid<real, D>& f) {
    target_ += entered;
    for_each_cell(f.extent(), [&](const Index<D>& I) {
        if (part_(I) < 1) f(I) = std::clamp(f(I), 0.0, 1.0);
    });
    const real missing = target_ - volume(f);
    if (missing == 0) return;
    if (gives_.empty()) gives_ = Grid<real, D>(f.extent());
    for (int level = 0; level < levels; ++level)
        if (const real corrected = give_back(state, level, missing, f); corrected != 0) {
            corrected_[0] += corrected, corrected_[1] += std::abs(corrected);
            return;
        }
}

/// f += λ f (1 − f) in the cells of a level, |λ| ≤ 1: f stays in [0, 1]. Returns the liquid that this adds [cells].
template <int D>
real VisibleLiquid<D>::give_back(const MacState<D>& state, int level, real missing, Grid<real, D>& f) {
    for_each_cell(f.extent(), [&](const Index<D>& I) {
        gives_(I) = 0;
        if (!is_mixed(f(I)) || !is_open(state, I)) return;
        if (level < mixed_cells && !is_surface(f, I)) return;
        if (level == near_solids && !is_swept_beside(I)) return;
        gives_(I) = f(I) * (1 - f(I));
    });
    const real available = sum_over(f.extent(), [&](const Index<D>& I) { return part_(I) * gives_(I); });
    if (available == 0) return 0;
    const real factor = std::clamp(missing / available, -1.0, 1.0);
    for_each_cell(f.extent(), [&](const Index<D>& I) { f(I) += factor * gives_(I); });
    return factor * available;
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
void UncoveredFaces<D>::remember(const MacState<D>& state) {
    for (std::size_t a = 0; a < D; ++a) {
        const auto& open = state.solid.open[a];
        if (was_closed_[a].empty()) was_closed_[a] = Grid<std::uint8_t, D>(open.extent());
        for_each_cell(open.extent(), [&](const Index<D>& I) { was_closed_[a](I) = open(I) == 0; });
    }
}

template <int D>
void UncoveredFaces<D>::settle(MacState<D>& state, const Densities& rho, const FaceFractions<D>& fractions) {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto &open = state.solid.open[at], &velocity = state.solid.velocity[at];
        for_each_free_face(state.u, state.sides, a, [&](const Index<D>& I) {
            if (open(I) == 0 || !was_closed_[at](I)) return;
            const real density = rho.of(fractions[at](I));
            real least = velocity(I), most = least;
            for (int d = 0; d < D; ++d)
                for (const int way : {-1, 1}) {
                    Index<D> J = I;
                    J[d] += way;
                    if (!open.contains(J) || was_closed_[at](J) || open(J) < least_trusted_fraction) continue;
                    if (rho.of(fractions[at](J)) < similar * density) continue;
                    least = std::min(least, state.u[a](J)), most = std::max(most, state.u[a](J));
                }
            state.u[a](I) = std::clamp(state.u[a](I), least, most);
        });
    }
    sync_periodic(state.u, state.sides);
}

template <int D>
std::size_t UncoveredFaces<D>::bytes() const {
    std::size_t total = 0;
    for (const auto& closed : was_closed_) total += closed.bytes();
    return total;
}

template class UncoveredFaces<2>;
template class UncoveredFaces<3>;
template class VisibleLiquid<2>;
template class VisibleLiquid<3>;

}  // namespace weir::two_phase
