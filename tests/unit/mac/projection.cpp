// After a projection the divergence that is left is the residual of the pressure solve: an identity, whatever the solver reached.
#include "mac/grid/projection.hpp"

#include "support/grid_solvers.hpp"
#include "support/test.hpp"

namespace weir::smoke::projection_tests {

namespace {

const char* const noise = "initial = { velocity = { name = \"random\", seed = 7 } }\nfluid = { density = 3.0 }\n";

/// One step of noise whose pressure is solved by exactly `iterations` iterations.
template <int D>
std::unique_ptr<FlowSolver<D>> stepped(const std::string& method, int iterations, const std::string& more, StepReport& report) {
    const std::string scheme = "scheme = { advection = \"semi_lagrangian\", poisson = { method = \"" + method +
                               "\", fixed = true, max_iterations = " + std::to_string(iterations) + " } }\n";
    auto flow = std::make_unique<FlowSolver<D>>(test::mac_scene(test::unit_box(D, 16, noise + scheme + more)));
    report = flow->step(0.01);
    return flow;
}

}  // namespace

TEST_IN_2D_AND_3D("the divergence left by a projection is dt/rho times the Poisson residual, at any iteration count") {
    for (const int iterations : {1, 2, 4, 8, 16}) {
        StepReport report;
        const auto flow = stepped<D>("red_black", iterations, "", report);
        const real predicted = report.dt / flow->state().rho * report.residual_max;
        // Round-off of a divergence: a few units in the last place of u/h, here 1e-16 * 2 * 16.
        EXPECT_NEAR(report.max_divergence, predicted, 1e-13 + 1e-10 * predicted) << iterations << " iterations";
        EXPECT_GT(predicted, 1e-6) << "nothing is left: the test says nothing";
    }
}

TEST_IN_2D_AND_3D("the identity holds with open sides, fractions of faces and cells that are not cubes") {
    const std::string more = std::string("sides = { y_max = { kind = \"open\" } }\n") +
                             "solids = [ { shape = \"sphere\", centre = " + test::list(D, "0.4") + ", radius = 0.23 } ]\n";
    for (const int iterations : {1, 5}) {
        StepReport report;
        const auto flow = stepped<D>("red_black", iterations, more, report);
        const real predicted = report.dt / flow->state().rho * report.residual_max;
        EXPECT_NEAR(report.max_divergence, predicted, 1e-13 + 1e-10 * predicted);
        EXPECT_GT(predicted, 1e-6);
    }
}

TEST_IN_2D_AND_3D("a projected velocity is not changed by a second projection") {
    auto scene = test::mac_scene(test::unit_box(D, 16, std::string(noise) + "scheme = { poisson = { tolerance = 1e-12 } }\n"));
    FlowSolver<D> flow(scene);
    auto& s = flow.state();
    Projection<D> projection(PoissonChoice(scene.root().table("scheme.poisson")), s);
    for_each_cell(s.u[0].extent(), [&](const Index<D>& I) {
        if (I[0] > 0 && I[0] < 16) s.u[0](I) += std::sin(3 * I[0] + I[D - 1]);
    });
    projection.project(s, 1);
    const auto once = s.u;
    s.p.fill(0);
    projection.project(s, 1);
    real largest = 0;
    for (int a = 0; a < D; ++a)
        for (std::size_t i = 0; i < s.u[a].size(); ++i) largest = std::max(largest, std::abs(s.u[a][i] - once[a][i]));
    EXPECT_LE(largest, 1e-10);  // tolerance 1e-12 times the condition of the gradient, n² = 256
}

// Wrong weights of an axis give the residual of another equation: the two sides then differ in their first digit.
TEST_IN_2D_AND_3D("the identity holds in cells that are not cubes, whichever edge is the longest") {
    for (const auto& cells : {std::array{"16, 8, 5", "1.0, 1.0, 1.0"}, std::array{"6, 12, 9", "0.5, 2.0, 3.0"}}) {
        const auto first = [](const std::string& list) { return D == 3 ? list : list.substr(0, list.rfind(',')); };
        const std::string text = std::string("solver = \"mac\"\ndim = ") + (D == 2 ? "2" : "3") + "\ngrid = { cells = [" + first(cells[0]) +
                                 "], size = [" + first(cells[1]) + "] }\ntime = { end = 1.0 }\n" + noise +
                                 "scheme = { advection = \"semi_lagrangian\", poisson = { method = \"red_black\", fixed = true, "
                                 "max_iterations = 4 } }\n";
        FlowSolver<D> flow(test::mac_scene(text));
        const StepReport report = flow.step(0.01);
        const real predicted = report.dt / flow.state().rho * report.residual_max;
        EXPECT_NEAR(report.max_divergence, predicted, 1e-13 + 1e-10 * predicted) << cells[0];  // round-off, as above
        EXPECT_GT(predicted, 1e-6);
    }
}

}  // namespace weir::smoke::projection_tests
