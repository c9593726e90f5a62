// Confinement by rows against its equation written cell by cell.
#include "smoke/effects.hpp"

#include "mac/grid/random_flow.hpp"
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

namespace weir::smoke::confinement_tests {

namespace {

constexpr real epsilon = 0.3, dt = 0.1;

/// ω = ∇ × u at a cell's centre.
template <int D>
std::array<real, 3> vorticity_at(const MacState<D>& s, const Index<D>& I) {
    const auto centre = [&](int a, const Index<D>& J) { return 0.5 * (s.before[a](J) + s.before[a](J + e<D>(a))); };
    const auto slope = [&](int a, int b) { return (centre(a, I + e<D>(b)) - centre(a, I - e<D>(b))) / (2 * s.u.h[b]); };
    if constexpr (D == 2)
        return {0, 0, slope(1, 0) - slope(0, 1)};
    else
        return {slope(2, 1) - slope(1, 2), slope(0, 2) - slope(2, 0), slope(1, 0) - slope(0, 1)};
}

/// f = ε h (N × ω),  N = ∇|ω| / |∇|ω||
template <int D>
std::array<real, 3> force_at(const MacState<D>& s, const Index<D>& I) {
    const auto size = [](const std::array<real, 3>& w) { return std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]); };
    std::array<real, 3> n{};
    for (int a = 0; a < D; ++a) {
        Index<D> lo = I, hi = I;
        lo[a] = std::max(I[a] - 1, 0);
        hi[a] = std::min(I[a] + 1, s.extent()[a] - 1);
        n[static_cast<std::size_t>(a)] = (size(vorticity_at(s, hi)) - size(vorticity_at(s, lo))) / ((hi[a] - lo[a]) * s.u.h[a]);
    }
    const real length = size(n), strength = s.cells(I) == poisson::Cell::fluid ? epsilon * s.u.h[0] : 0;
    for (real& component : n) component = length > 0 ? component / length : 0;
    const auto w = vorticity_at(s, I);
    return {strength * (n[1] * w[2] - n[2] * w[1]), strength * (n[2] * w[0] - n[0] * w[2]), strength * (n[0] * w[1] - n[1] * w[0])};
}

}  // namespace

TEST_IN_2D_AND_3D("vorticity confinement pushes every inner face by the mean of its two cells, and nothing in solids") {
    const auto scene = test::mac_scene(test::unit_box(D, 13,
                                                      "solids = [ { shape = \"sphere\", centre = " + test::list(D, "0.4") +
                                                          ", radius = 0.2 } ]\neffects = { confinement = { epsilon = 0.3 } }\n"));
    auto effects = make_effects<D>(effect_kinds(), scene, all_stages);
    MacState<D> state(scene, effects.plan());
    state.before = PaddedVelocity<D>(state.u);
    set_random_flow(state.u, 1, 3);
    for (int a = 0; a < D; ++a) fill(state.before[a], state.u[a], state.boundary[static_cast<std::size_t>(a)]);
    state.cells(Index<D>::constant(4)) = poisson::Cell::solid;
    const auto u = state.u;
    Passes passes;
    effects.apply(Stage::force, state, dt, passes);
    for (int a = 0; a < D; ++a)
        for_each_inner_face(u, a, [&](const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            const real push = 0.5 * dt * (force_at(state, I)[at] + force_at(state, I - e<D>(a))[at]);
            EXPECT_NEAR(state.u[a](I) - u[a](I), push, 1e-14 * 13);  // round-off of differences over h
        });
}

}  // namespace weir::smoke::confinement_tests
