// Viscosity with a jump: shear flows between walls, rigid rotation, momentum.
#include "support.hpp"

namespace viscosity_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

/// Two layers between walls, the lower one of liquid; x (and z) are periodic.
std::string layers(const std::string& sides, int ny = 16) {
    return fmt::format(R"(solver = "two_phase"
dim = 2
grid = {{ cells = [4, {}], size = [0.25, 1.0], periodic = ["x"] }}
time = {{ end = 100.0 }}
fluid = {{ density = 1000.0, viscosity = 0.1 }}
gas = {{ density = 1.0, viscosity = 10.0 }}
liquid = [ {{ shape = "box", min = [-1.0, -1.0], max = [2.0, 0.5] }} ]
effects = {{ viscosity = {{}} }}
sides = {{ {} }}
scheme = {{ poisson = {{ tolerance = 1e-12 }} }}
)",
                       ny, sides);
}

}  // namespace

// The stress is one constant: u is linear in each layer, with slopes in the ratio of the viscosities, 10 (0.1 x 1000 to 10 x 1). On a face
// between the layers mu is the mean of both cells, 55, instead of the harmonic one: the whole resistance of n - 1 cells and two halves is
// sum h/mu.
TEST("steady shear of two layers has one stress") {
    const int n = 16;
    TwoPhase<2> solver(
        two_phase_scene(layers("y_min = { kind = \"wall\", slip = \"no\" }, y_max = { kind = \"moving_wall\", velocity = [1.0, 0.0] }")));
    for (int step = 0; step < 80; ++step) solver.step(0.5);  // 40 times the longest relaxation time, about 1 s
    const auto& u = solver.state().u[0];
    const real h = 1.0 / n, liquid = 100, gas = 10;
    const real resistance = h * (n / 2 - 0.5) / liquid + h * (n / 2 - 0.5) / gas + h / (0.5 * (liquid + gas));
    const real stress = 1 / resistance;
    EXPECT_NEAR(u({{0, 0}}), stress * 0.5 * h / liquid, 1e-6);
    EXPECT_NEAR(u({{0, n / 2 - 1}}), stress * h * (n / 2 - 0.5) / liquid, 1e-6);
    EXPECT_NEAR(u({{0, n - 1}}), 1 - stress * 0.5 * h / gas, 1e-6);
}

// A plate without slip that moves along itself, on a grid line, is a moving wall; both solves end at 1e-10.
TEST("a plate in motion shears both fluids as a moving wall of the domain does") {
    const std::string lid = "y_min = { kind = \"wall\", slip = \"no\" }, y_max = { kind = \"wall\", slip = \"no\" }";
    TwoPhase<2> plate(
        two_phase_scene(layers(lid), {{"solids",
                                       "[ { shape = \"box\", min = [-100.0, -1.0], max = [100.0, 0.25], slip = \"no\", motion = { kind "
                                       "= \"constant\", velocity = [0.5, 0.0] } } ]"}}));
    TwoPhase<2> wall(two_phase_scene(layers("y_min = { kind = \"moving_wall\", velocity = [0.5, 0.0] }, y_max = { kind = \"wall\", slip = "
                                            "\"no\" }",
                                            12),
                                     {{"grid.size", "[0.25, 0.75]"}, {"grid.origin", "[0.0, 0.25]"}}));
    for (int step = 0; step < 30; ++step) {
        plate.step(0.05), wall.step(0.05);
        for (int j = 0; j < 12; ++j)
            ASSERT_NEAR(plate.state().u[0]({{1, j + 4}}), wall.state().u[0]({{1, j}}), 1e-8) << "step " << step << ", row " << j;
    }
    EXPECT_GT(wall.state().u[0]({{1, 8}}), 0.01);
}

// cos(pi y) between walls without friction is a mode of the discrete operator, with the eigenvalue 2 (1 - cos(pi h)) / h^2; a step is
// implicit (backward Euler). The tolerance of the viscous solve is 1e-10.
TEST("a shear wave decays by its eigenvalue, implicit in time") {
    const auto scene = two_phase_scene(layers("y_min = { kind = \"wall\" }"),
                                       {{"liquid", "[ { shape = \"box\", min = [-1.0, -1.0], max = [2.0, 2.0] } ]"}});
    TwoPhase<2> base(scene);
    mac::MacState<2> state(scene, FieldPlan{});
    for_each_cell(state.u[0].extent(), [&](const Index<2>& I) { state.u[0](I) = std::cos(pi * state.u.face_centre(0, I)[1]); });
    mac::Padded<2> f(state.extent());
    two_phase::FractionGhosts<2>(state.sides, -1, {}).fill_all(f, base.fraction());
    const mac::MacVelocity<2> before = state.u;
    const real h = 1.0 / 16, mu = 100, rho = 1000, dt = 0.3;
    two_phase::Viscosity<2>(state, {{}, state}, mu, 10).apply(state, f, base.face_fractions(), {rho, 1}, dt);
    const real decay = 1 / (1 + dt * mu / rho * 2 * (1 - std::cos(pi * h)) / (h * h));
    for (int j = 0; j < 16; ++j) EXPECT_NEAR(state.u[0]({{2, j}}), decay * before[0]({{2, j}}), 1e-9);
}

// The tolerance of the viscous solve is 1e-10.
TEST("walls without friction do not slow a flow, walls without slip do") {
    const auto speed_after = [](const std::string& sides) {
        TwoPhase<2> solver(two_phase_scene(layers(sides), {{"initial.velocity", "{ name = \"constant\", value = [1.0, 0.0] }"}}));
        for (int step = 0; step < 5; ++step) solver.step(0.05);
        return solver.state().u[0]({{0, 0}});
    };
    EXPECT_NEAR(speed_after("y_min = { kind = \"wall\" }"), 1, 1e-8);
    EXPECT_LT(speed_after("y_min = { kind = \"wall\", slip = \"no\" }"), 0.5);
}

// 2 mu D vanishes for a rotation, whatever mu; without the transposed gradient it does not where mu jumps.
TEST("a rotating block with a jump of viscosity feels no stress inside") {
    auto text = layers("y_min = { kind = \"wall\" }");
    TwoPhase<2> base(two_phase_scene(text, {{"grid.cells", "[16, 16]"}, {"grid.size", "[1.0, 1.0]"}, {"grid.periodic", "[]"}}));
    mac::MacState<2> state(two_phase_scene(text, {{"grid.cells", "[16, 16]"}, {"grid.size", "[1.0, 1.0]"}, {"grid.periodic", "[]"}}),
                           FieldPlan{});
    for (int a = 0; a < 2; ++a)
        for_each_cell(state.u[a].extent(), [&](const Index<2>& I) {
            const Vec<2> x = state.u.face_centre(a, I);
            state.u[a](I) = a == 0 ? -(x[1] - 0.5) : x[0] - 0.5;
        });
    mac::Padded<2> f(state.extent());
    two_phase::FractionGhosts<2>(state.sides, -1, {}).fill_all(f, base.fraction());
    const mac::MacVelocity<2> before = state.u;
    two_phase::Viscosity<2>(state, {{}, state}, 100, 10).apply(state, f, base.face_fractions(), {1000, 1}, 1e-6);
    // A stress of mu / 1 s on one side of a face would change it by dt (100 - 10) Pa / (h rho) = 3e-6 m/s. Walls, which do not rotate, are
    // four cells away, over each of which their effect falls by nu dt/h^2 = 2.6e-3.
    for (int a = 0; a < 2; ++a)
        for (int j = 4; j < 12; ++j)
            for (int i = 4; i < 12; ++i) EXPECT_NEAR(state.u[a]({{i, j}}), before[a]({{i, j}}), 1e-8);
}

}  // namespace viscosity_tests
