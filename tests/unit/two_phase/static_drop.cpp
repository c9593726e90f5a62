// Drops that must not move, and drops that must not notice the motion of all fluid.
#include "support.hpp"

namespace static_drop_tests {

using namespace weir;
using namespace weir::test;
using two_phase::Experiment;
using two_phase::TwoPhase;

namespace {

const char* const tension = "effects = { surface_tension = { sigma = 1.0 } }";

}  // namespace

// sigma kappa (f(I) − f(N)) is the difference of a cell field, so the pressure balances it exactly: what is left is the residual of the
// solve, 1e-12 of sigma kappa / rho_g h dt = 5 x 32 x 6e-3 m/s.
TEST_IN_2D_AND_3D("a drop 1000:1 of given curvature stays at rest, and its pressure is that of Laplace") {
    const int n = D == 2 ? 32 : 16;
    TwoPhase<D> solver(two_phase_scene(drop<D>(n, tension)), {}, Experiment{.fixed_curvature = 5});
    run(solver, 10);
    EXPECT_LT(max_speed(solver), 1e-12);
    Index<D> middle = Index<D>::constant(n / 2);
    EXPECT_NEAR(solver.state().p(middle) - solver.state().p(Index<D>::constant(0)), 5, 1e-9);
}

// R = 6.4 h. Error of curvature: the fourth-order term of a sphere within the reach r² = 6.5 h² of a fit, r²/(4 R²) = 4%. Speed: a tenth of
// the capillary speed sqrt(sigma/(rho D)) = 0.05 m/s.
TEST_IN_2D_AND_3D("a drop with computed curvature creeps, and its pressure is that of Laplace to 4%") {
    const int n = 32;
    TwoPhase<D> solver(two_phase_scene(drop<D>(n, tension)));
    run(solver, 5);
    EXPECT_LT(max_speed(solver), 0.005);
    const real exact = (D - 1) / 0.2;
    EXPECT_NEAR(solver.state().p(Index<D>::constant(n / 2)) - solver.state().p(Index<D>::constant(0)), exact, 0.04 * exact);
}

// Every flux carries one velocity: round-off of its sums, 1e-16 per step and term; the densities of a cell are 1 to 1000 apart.
TEST_IN_2D_AND_3D("drop and gas at one velocity keep it") {
    const int n = D == 2 ? 32 : 16;
    const auto scene =
        two_phase_scene(drop<D>(n, "initial.velocity = { name = \"constant\", value = " + list({"1.0", "0.7", "-0.4"}, D) + " }"));
    TwoPhase<D> solver(scene);
    run(solver, 30);
    const Vec<3> exact{{1, 0.7, -0.4}};
    for (int a = 0; a < D; ++a) EXPECT_LT(mac::max_magnitude(solver.state().u[a], exact[a]), 1e-12);
    EXPECT_GT(solver.time(), 0.2);
}

}  // namespace static_drop_tests
