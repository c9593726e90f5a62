// What stands inside solids: tangentially the flow beside them, through the surface the solid's own velocity.
#include "mac/bodies/solid_faces.hpp"

#include "support/grid_solvers.hpp"
#include "support/test.hpp"

namespace weir::smoke::solid_faces_tests {

namespace {

std::string ball(int dim, const std::string& motion) {
    return "solids = [ { shape = \"sphere\", centre = " + test::list(dim, "0.5") + ", radius = 0.23" + motion + " } ]\n";
}

}  // namespace

TEST_IN_2D_AND_3D("a uniform flow is continued into a ball without what would pass through its surface: u - (u.n) n") {
    const auto scene = test::mac_scene(test::unit_box(D, 24, ball(D, "")));
    MacState<D> state(scene, {});
    state.before = PaddedVelocity<D>(state.u);
    SolidPlacement<D> solids(geometry::Solids<D>(scene.root().tables("solids")), state);
    Vec<D> u{};
    for (int a = 0; a < D; ++a) {
        u[a] = 1 + 0.5 * a;
        state.u[a].fill(u[a]);
        fill(state.before[a], state.u[a], state.boundary[static_cast<std::size_t>(a)]);
    }
    solids.extend_velocity(state);
    int continued = 0;
    for (int a = 0; a < D; ++a) {
        const auto& open = state.solid.open[static_cast<std::size_t>(a)];
        for_each_cell(open.extent(), [&](const Index<D>& I) {
            bool beside = false;
            for (int b = 0; b < D; ++b)
                for (const Index<D>& N : {I - e<D>(b), I + e<D>(b)}) beside = beside || (open.contains(N) && open(N) > 0);
            if (open(I) > 0 || !beside) return;
            const Vec<D> away = state.u.face_centre(a, I) - Vec<D>::constant(0.5), n = (1 / norm(away)) * away;
            EXPECT_NEAR(state.before[a](I), u[a] - dot(u, n) * n[a], 1e-5);  // n by differences over h/1000: (h/1000)^2/R^2 and round-off
            ++continued;
        });
    }
    EXPECT_GT(continued, 10 * D);
}

TEST("a cylinder that swings in inviscid fluid neither makes nor loses momentum, and the flow stays smooth") {
    // The case impulse.toml at 48 cells for three quarters of a swing. Momentum may be lost or gained where faces are cut, one layer
    // around the body: h/R = 0.14 of what is exchanged, and as much again where faces open and close. A flow that feeds on what it
    // continues into the body passes any such bound within this time (twice the exchange at 128 cells).
    const std::string rest = "fluid = { density = 1.2 }\nscheme = { advection = \"conservative\", poisson = { tolerance = 1e-8 } }\n";
    const std::string swing = ", motion = { kind = \"sinusoidal\", amplitude = [0.15, 0.0], frequency = 0.5 }";
    FlowSolver<2> flow(test::mac_scene(test::unit_box(2, 48, rest + ball(2, swing)), {{"grid.periodic", "[\"x\"]"}}));
    const auto value = [&](const char* name) {
        for (const Integral& i : flow.integrals())
            if (i.name == name) return i.value;
        return not_applicable;
    };
    const real first = value("momentum_x");
    real missing = 0, exchanged = 0, speed = 0;
    while (flow.time() < 1.5) {
        flow.step(std::min(flow.advised_dt(), 0.02));
        missing = std::max(missing, std::abs(value("momentum_x") - first + value("solid_impulse_x")));
        exchanged = std::max(exchanged, std::abs(value("solid_impulse_x")));
        speed = std::max(speed, value("max_speed"));
    }
    EXPECT_LT(missing, 2 * (1.0 / 48) / 0.23 * exchanged);
    EXPECT_LT(speed, 4 * 0.15 * pi);  // potential flow past a cylinder is twice as fast as the body; blocked by the walls, up to 4 times
}

}  // namespace weir::smoke::solid_faces_tests
