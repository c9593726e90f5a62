// Transport of liquid alone, and the fractions of faces.
#include "support.hpp"

namespace transport_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

// Halves of one cell below one plane: their sum over all faces of an axis is the volume, to the round-off of cuts.
TEST_IN_2D_AND_3D("the control volumes of the faces of an axis hold the liquid of all cells") {
    TwoPhase<D> solver(two_phase_scene(drop<D>(16)));
    const real volume = sum_over(solver.fraction().extent(), [&](const Index<D>& I) { return solver.fraction()(I); });
    for (int a = 0; a < D; ++a) {
        const auto& faces = solver.face_fractions()[static_cast<std::size_t>(a)];
        EXPECT_NEAR(sum_over(solver.fraction().extent(), [&](const Index<D>& I) { return faces(I); }), volume, 1e-11);
    }
}

// 16 sub-cells per cell: the middle of a chord of a sub-cell is h²/(8 · 16² R) from the circle, (h/16)²/(12 R) on average.
TEST("the fractions of a circle have its area") {
    TwoPhase<2> solver(two_phase_scene(drop<2>(32)));
    const real exact = pi * 0.2 * 0.2, h = 1.0 / 32;
    EXPECT_NEAR(integral(solver, "volume") / exact, 1, 2 * (h / 16) * (h / 16) / (12 * 0.2 * 0.2));
}

TEST_IN_2D_AND_3D("the sweeps of a step take every order in turn") {
    std::vector<std::array<int, D>> seen;
    for (int step = 0; step < (D == 2 ? 2 : 6); ++step) {
        auto order = two_phase::sweep_order<D>(step);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), order), 0);
        seen.push_back(order);
        std::sort(order.begin(), order.end());
        for (int d = 0; d < D; ++d) EXPECT_EQ(order[static_cast<std::size_t>(d)], d);
    }
}

// Each sweep compresses or expands the volumes; momentum is restored with the same dilation as mass. Round-off of densities 1 to 1000.
TEST("a component that is uniform stays uniform in a flow that varies across it") {
    set_threads(1);
    const int n = 16;
    const auto scene = two_phase_scene(drop<3>(n));
    const TwoPhase<3> solver(scene);
    mac::MacState<3> state(scene, FieldPlan{});
    const auto psi = [&](int i, int j) { return std::sin(2 * pi * i / n) * std::sin(2 * pi * j / n); };
    for_each_cell(replicated(state.u[0].extent()), [&](const Index<3>& I) { state.u[0](I) = psi(I[0], I[1] + 1) - psi(I[0], I[1]); });
    for_each_cell(replicated(state.u[1].extent()), [&](const Index<3>& I) { state.u[1](I) = psi(I[0], I[1]) - psi(I[0] + 1, I[1]); });
    state.u[2].fill(1);
    mac::PaddedVelocity<3> u(state.u);
    for (int a = 0; a < 3; ++a) fill(u[a], state.u[a], state.boundary[static_cast<std::size_t>(a)]);
    two_phase::Transport<3> transport(state, {}, {});
    for (int step = 0; step < 6; ++step)
        transport.advect_momentum(2, {u, u, 0.02, two_phase::sweep_order<3>(step)}, solver.face_fractions()[2], state.boundary[2],
                                  {1000, 1}, state.u[2]);
    EXPECT_LT(mac::max_magnitude(state.u[2], 1), 1e-12);
    EXPECT_GT(mac::max_magnitude(state.u[0]), 0.3) << "the flow varies";
}

// f = 1e-10 and 1 − 1e-10 beside a mixed cell: both are handed to it, nothing is lost.
TEST("dust goes to the neighbour that is closest to one half, and the sum stays") {
    const auto scene = two_phase_scene(drop<2>(16));
    const TwoPhase<2> solver(scene);
    const mac::MacState<2>& state = solver.state();
    Grid<real, 2> f(state.extent());
    f({{5, 5}}) = 0.4, f({{6, 5}}) = 0.9, f({{4, 5}}) = 1e-10, f({{5, 4}}) = 1 - 2e-10, f({{0, 0}}) = 3e-10, f({{15, 15}}) = 0.5;
    f({{10, 10}}) = 1e-10;  // without such a neighbour: it stays
    mac::Padded<2> padded(state.extent());
    two_phase::FractionGhosts<2>(state.sides, -1, {}).fill_all(padded, f);
    two_phase::hand_on_dust(padded, two_phase::Around<2>(state.sides, state.u.cells), state.cells, f);
    EXPECT_EQ(f({{4, 5}}), 0);
    EXPECT_EQ(f({{5, 4}}), 1);
    EXPECT_EQ(f({{0, 0}}), 0) << "through the periodic corner";
    EXPECT_EQ(f({{15, 15}}), 0.5 + 3e-10);
    EXPECT_NEAR(f({{5, 5}}), 0.4 - 1e-10, 1e-16);
    EXPECT_EQ(f({{10, 10}}), 1e-10);
}

// 1e-10 of liquid of 350 K leaves a cell of gas for one with 0.4 of it, 2e-10 of gas of 290 K a cell of liquid; as much of the other fluid
// comes back from there.
TEST("dust takes its heat along") {
    const auto scene = two_phase_scene(drop<2>(16));
    const TwoPhase<2> solver(scene);
    const mac::MacState<2>& state = solver.state();
    Grid<real, 2> f(state.extent());
    f({{5, 5}}) = 0.4, f({{4, 5}}) = 1e-10, f({{5, 4}}) = 1 - 2e-10;
    const Grid<real, 2> before = f;
    std::array<Grid<real, 2>, 2> T{Grid<real, 2>(state.extent(), 320.0), Grid<real, 2>(state.extent(), 310.0)};
    T[0]({{4, 5}}) = 350, T[1]({{5, 4}}) = 290;
    const two_phase::FractionGhosts<2> ghosts(state.sides, -1, {});
    mac::Padded<2> padded(state.extent());
    std::array<mac::Padded<2>, 2> copies{padded, padded};
    ghosts.fill_all(padded, f);
    for (std::size_t phase = 0; phase < 2; ++phase) ghosts.fill_all(copies[phase], T[phase]);
    const two_phase::CarriedByDust<2> carried{copies, T};
    two_phase::hand_on_dust(padded, two_phase::Around<2>(state.sides, state.u.cells), state.cells, f, &carried);
    EXPECT_EQ(f({{4, 5}}), 0);
    EXPECT_EQ(f({{5, 4}}), 1);
    EXPECT_NEAR((T[0]({{5, 5}}) - 320) / (1e-10 * 30 / 0.4), 1, 1e-3);
    EXPECT_NEAR((T[1]({{5, 5}}) - 310) / (2e-10 * -20 / 0.6), 1, 1e-3);
    EXPECT_EQ(T[1]({{4, 5}}), 310) << "gas came, as warm as that of the cell";
    EXPECT_EQ(T[0]({{5, 4}}), 320);
}

}  // namespace transport_tests
