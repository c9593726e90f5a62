// Bodies with no slip in a viscous fluid: torque between cylinders, what the fluid loses and the body gets, bodies without mass, restart.
#include "smoke/body_friction.hpp"
#include "support.hpp"

namespace friction_tests {

using namespace weir;
using namespace weir::test;

namespace {

std::string sticky(const std::string& bodies, int cells, real nu, const char* gravity = "[0.0, 0.0]") {
    return fmt::format(R"(solver = "mac"
dim = 2
grid = {{ cells = [{0}, {0}], size = [1.25, 1.25] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0, viscosity = {1} }}
effects = {{ gravity = {{ g = {2} }}, viscosity = {{ scheme = "implicit" }} }}
bodies = [ {3} ]
)",
                       cells, nu, gravity, bodies);
}

const char* heavy_disc = "{ shape = \"sphere\", centre = [0.625, 0.625], radius = 0.25, density = 1e9, spin = [1.0], slip = \"no\" }";
const char* ring =
    "solids = [ { shape = \"difference\", from = { shape = \"box\", min = [-1.0, -1.0], max = [3.0, 3.0] }, minus = [ { shape = "
    "\"sphere\", "
    "centre = [0.625, 0.625], radius = 0.5 } ], slip = \"no\" } ]\n";

/// Relative error of the torque on a disc of a = 0.25 m that turns at 1 rad/s in a ring of b = 0.5 m.
real torque_error(int cells) {
    const real nu = 1, mu = 1000 * nu, a = 0.25, b = 0.5;
    const auto solver = solver_of(sticky(heavy_disc, cells, nu) + ring);
    for (int i = 0; i < 40; ++i) solver->step(0.01);
    const real exact = 4 * pi * mu * a * a * b * b / (b * b - a * a);  // Couette's flow
    return std::abs(shown(*solver, "viscous_torque", 0) / -exact - 1);
}

}  // namespace

TEST("the torque on a disc that turns in a ring is exact to a quarter of a cell of the ring's place, and converges") {
    const OneThread alone;
    // The torque is as 1/(1/a^2 - 1/b^2): of a ring that stood a quarter of a cell too deep, db = h/4, it would be less by
    // 2 a^2/(b^2 - a^2) db/b = 1/6 of h/b.
    const real coarse = torque_error(25), fine = torque_error(50);
    EXPECT_LT(coarse, 1.0 / 6 * 0.1);
    EXPECT_LT(fine, 1.0 / 6 * 0.05);
    EXPECT_LT(fine, coarse);
}

TEST("what friction takes from the fluid the body gets, but for what the sides take") {
    const OneThread alone;
    const auto scene = scene_of(
        sticky("{ shape = \"sphere\", centre = [0.6, 0.7], radius = 0.2, density = 2000.0, slip = \"no\" }", 32, 1e-2, "[0.0, -9.81]"));
    smoke::FlowSolver<2> solver(scene);
    for (int i = 0; i < 5; ++i) solver.step(0.01);
    auto& s = solver.state();
    const auto momentum = [&] {
        real sum = 0;
        for_each_in(Index<2>{}, s.u[1].extent(), [&](const Index<2>& I) {
            if (s.no_slip_walls->takes_part[1](I) != 0) sum += s.rho * s.u.cell_volume() * s.u[1](I);
        });
        return sum;
    };
    smoke::BodyFriction<2> friction(s);
    const real dt = 0.01, before = momentum();
    friction.solve(s, dt);
    real sides = 0;  // the ends of the box hold the fluid that runs at them
    for (int i = 0; i < 32; ++i)
        for (const int j : {1, 31}) sides -= dt * s.nu * s.rho * s.u[1]({i, j});
    const real got = s.no_slip_walls->bodies[0].impulse[1];
    EXPECT_GT(got, 0.1);  // [N s/m]: the disc of 251 kg/m sinks, and friction holds it
    // The tolerance of the solve is 1e-6 of its right-hand side, in the norm that momentum has.
    EXPECT_NEAR(momentum() - before + got, sides, 1e-4 * got);
}

TEST("a disc without mass is carried and turned by viscous fluid, whatever the step") {
    const OneThread alone;
    const auto solver = solver_of(sticky(
        "{ shape = \"sphere\", centre = [0.6, 0.4], radius = 0.2, density = 0.0, spin = [10.0], slip = \"no\" }", 32, 0.1, "[0.0, -9.81]"));
    real fastest = 0;
    for (int i = 0; i < 20; ++i) {
        solver->step(0.02);  // dt nu/h^2 = 1.3
        fastest = std::max(fastest, std::abs(shown(*solver, "velocity", 1)));
    }
    // Stokes' balance in 2D without the walls' logarithm, g a^2/(4 nu): no more than that.
    EXPECT_LT(fastest, 9.81 * 0.04 / 0.4);
    EXPECT_GT(shown(*solver, "velocity", 1), 0.0);
    EXPECT_LT(std::abs(shown(*solver, "spin", 0)), 1.0);  // nothing kept it turning
}

TEST("a body with friction goes on after a restart as if nothing had been") {
    const OneThread alone;
    const auto scene =
        scene_of(sticky("{ shape = \"box\", min = [0.4, 0.6], max = [0.7, 0.8], density = 1500.0, spin = [2.0], slip = \"no\" }", 32, 1e-3,
                        "[0.0, -9.81]"));
    const auto solver = smoke::kind().make(scene, {}), again = smoke::kind().make(scene, {});
    for (int i = 0; i < 5; ++i) solver->step(0.005);
    Checkpoint kept;
    solver->save(kept);
    again->restore(kept);
    for (int i = 0; i < 5; ++i) solver->step(0.005), again->step(0.005);
    for (const char* field : {"position", "velocity", "force", "viscous_force"})
        for (std::size_t c = 0; c < 2; ++c) EXPECT_EQ(shown(*solver, field, c), shown(*again, field, c)) << field;
}

}  // namespace friction_tests
