// Bodies with no slip in a liquid with a free surface: torque between cylinders, what the one loses and the other gets, restart, threads.
#include "mac/bodies/bodies_in_flow.hpp"
#include "support.hpp"

namespace friction_in_water_tests {

using namespace weir;
using namespace weir::test;
using namespace weir::free_surface;

namespace {

/// A box of 1.25 m, full of liquid or to a depth.
std::string sticky(const std::string& bodies, int cells, real nu, const char* gravity = "[0.0, 0.0]", real depth = 2) {
    return fmt::format(R"(solver = "mac_water"
dim = 2
grid = {{ cells = [{0}, {0}], size = [1.25, 1.25] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0, viscosity = {1} }}
liquid = [ {{ shape = "box", min = [-1.0, -1.0], max = [2.0, {4}] }} ]
effects = {{ gravity = {{ g = {2} }}, viscosity = {{ scheme = "implicit" }} }}
bodies = [ {3} ]
)",
                       cells, nu, gravity, bodies, depth);
}

/// Relative error of the torque on a disc of a = 0.25 m that turns at 1 rad/s in a ring of b = 0.5 m that is held; both are bodies.
std::array<real, 2> torque_errors(int cells) {
    const real nu = 1, mu = 1000 * nu, a = 0.25, b = 0.5;
    const auto solver = solver_of(
        sticky("{ shape = \"sphere\", centre = [0.625, 0.625], radius = 0.25, density = 1e9, spin = [1.0], slip = \"no\" }, { shape = "
               "\"difference\", from = { shape = \"box\", min = [0.05, 0.05], max = [1.2, 1.2] }, minus = [ { shape = \"sphere\", "
               "centre = [0.625, 0.625], radius = 0.5 } ], density = 1.0, slip = \"no\", fixed = [\"x\", \"y\", \"turning\"] }",
               cells, nu));
    for (int i = 0; i < 40; ++i) solver->step(0.01);
    const real exact = 4 * pi * mu * a * a * b * b / (b * b - a * a);  // Couette's flow
    return {shown(*solver, "viscous_torque", 0) / -exact - 1, shown(*solver, "viscous_torque", 0, 1) / exact - 1};
}

/// The same of a ball in a hollow ball, slowly: 8 pi mu a^3 b^3/(b^3 - a^3) (Landau & Lifshitz, Fluid Mechanics, section 20).
real torque_error_of_ball(int cells) {
    const real nu = 1, mu = 1000 * nu, a = 0.25, b = 0.5;
    const auto solver = solver_of(fmt::format(R"(solver = "mac_water"
dim = 3
grid = {{ cells = [{0}, {0}, {0}], size = [1.25, 1.25, 1.25] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0, viscosity = {1} }}
liquid = [ {{ shape = "sphere", centre = [0.625, 0.625, 0.625], radius = 0.6 }} ]
effects = {{ viscosity = {{ scheme = "implicit" }} }}
bodies = [ {{ shape = "sphere", centre = [0.625, 0.625, 0.625], radius = 0.25, density = 1e9, spin = [0.2, 0.0, 0.0], slip = "no" }},
           {{ shape = "difference", from = {{ {2} }}, minus = [ {{ {3} }} ], density = 1.0, slip = "no", fixed = ["x", "y", "z", "turning"] }} ]
)",
                                              cells, nu, "shape = \"box\", min = [0.02, 0.02, 0.02], max = [1.23, 1.23, 1.23]",
                                              "shape = \"sphere\", centre = [0.625, 0.625, 0.625], radius = 0.5"));
    for (int i = 0; i < 6; ++i) solver->step(0.02);
    const real exact = 0.2 * 8 * pi * mu * a * a * a * b * b * b / (b * b * b - a * a * a);
    return std::abs(shown(*solver, "viscous_torque", 0) / -exact - 1);
}

/// A ball that moves and turns in a box full of liquid that moves at random about it, and one step of friction.
template <int D>
struct FluidWithFriction {
    scene::Scene scene = scene_of(D == 2 ? R"(solver = "mac_water"
dim = 2
grid = { cells = [40, 40], size = [1.0, 1.0] }
time = { end = 1.0 }
fluid = { density = 1000.0, viscosity = 0.01 }
liquid = [ { shape = "box", min = [-1.0, -1.0], max = [2.0, 2.0] } ]
effects = { viscosity = { scheme = "implicit" } }
bodies = [ { shape = "sphere", centre = [0.51, 0.49], radius = 0.11, density = 2000.0, velocity = [1.0, 0.5], spin = [9.0], slip = "no" } ]
)"
                                         : R"(solver = "mac_water"
dim = 3
grid = { cells = [28, 28, 28], size = [0.7, 0.7, 0.7] }
time = { end = 1.0 }
fluid = { density = 1000.0, viscosity = 0.01 }
liquid = [ { shape = "box", min = [-1.0, -1.0, -1.0], max = [2.0, 2.0, 2.0] } ]
effects = { viscosity = { scheme = "implicit" } }
bodies = [ { shape = "sphere", centre = [0.36, 0.34, 0.35], radius = 0.07, density = 2e3, velocity = [1, 0.5, 0.2], spin = [9, 5, 2], slip = "no" } ]
)");
    MacState<D> s{scene, FieldPlan{}};
    mac::BodiesInFlow<D> bodies{scene};
    mac::SolidPlacement<D> solids{mac::BodiesInFlow<D>::solids(scene, &bodies), s};
    free_surface::Frame<D> frame{s.u, s.sides};
    free_surface::LevelSet<D> all_liquid{frame, 1};
    Grid<std::uint8_t, D> closed{s.extent()};
    MacVelocity<D> before;
    const rigid::Body<D>& body() const { return bodies.bodies()[0]; }

    explicit FluidWithFriction(real dt) {
        all_liquid.phi.fill(-1);
        for_each_cell(s.extent(), [&](const Index<D>& I) { closed(I) = s.cells(I) == poisson::Cell::solid; });
        std::uint64_t key = 0;
        for (int a = 0; a < D; ++a)
            for (std::size_t i = 0; i < s.u[a].size(); ++i) {
                const Index<D> I = mac::index_of<D>(s.u[a].extent(), i);
                const bool near = norm(s.u.face_centre(a, I) - body().at) < body().radius + 2 * s.u.h[0];
                s.u[a][i] = near ? hashed_random(7, ++key, 0) - 0.5 : 0;
            }
        bodies.start(s, solids);
        bodies.couple_friction(s, true);
        bodies.set_no_slip_walls(s, solids, dt);
        for (const auto& f : s.no_slip_walls->inside) s.u[f.axis](f.face) = 0;  // no liquid
        before = s.u;
        water::SurfaceViscosity<D> viscosity(frame, s, 1, true);
        viscosity.enforce_bodies(s);
        viscosity.set_tolerance(1e-15);
        viscosity.apply(s, all_liquid, closed, dt);
        for (const auto& f : s.no_slip_walls->inside) s.u[f.axis](f.face) = 0;
    }
    /// What the liquid has gained of momentum, then of angular momentum about the body.
    rigid::Twist<D> gained() const {
        rigid::Twist<D> sum{};
        for (int a = 0; a < D; ++a)
            for (std::size_t i = 0; i < s.u[a].size(); ++i) {
                const Vec<D> r = s.u.face_centre(a, mac::index_of<D>(s.u[a].extent(), i)) - body().at;
                const auto moves = mac::moves_at<D>(a, r);
                for (std::size_t k = 0; k < moves.size(); ++k) sum[k] += s.rho * s.u.cell_volume() * moves[k] * (s.u[a][i] - before[a][i]);
            }
        return sum;
    }
};

}  // namespace

// Of second order where walls are felt between the faces; of a torque as 1/(1/a^2 - 1/b^2) each wall's place counts 8/3 dr/a, and the
// gradient of the divergence, which counts faces and not parts of them, moves it by some hundredths of a cell: 0.02.
TEST("the torque between a disc that turns and a ring is exact to second order and a fiftieth of a cell, on both of them") {
    const OneThread alone;
    for (const int cells : {20, 30, 40, 50}) {
        const real h_over_a = 1.25 / cells / 0.25;
        for (const real error : torque_errors(cells))
            EXPECT_LT(std::abs(error), h_over_a * h_over_a + 8.0 / 3 * 0.02 * h_over_a) << cells << " cells";
    }
}

TEST("the torque on a ball that turns in a hollow ball is exact to second order and a fiftieth of a cell") {
    const OneThread alone;
    // As 1/(1/a^3 - 1/b^3): 3 dr/a times 8/7 of the ball's wall, half of that of the other.
    for (const int cells : {20, 25}) {
        const real h_over_a = 1.25 / cells / 0.25;
        EXPECT_LT(torque_error_of_ball(cells), h_over_a * h_over_a + 24.0 / 7 * 0.02 * h_over_a) << cells << " cells";
    }
}

TEST_IN_2D_AND_3D("of momentum and of angular momentum a body gets from friction what the liquid loses, to round-off") {
    const OneThread alone;
    const FluidWithFriction<D> with_friction(
        2e-4);  // dt nu/h^2 = 0.0032, of which the sides, nine cells from what moves, see the ninth power
    const auto gained = with_friction.gained();
    const auto& got = with_friction.s.no_slip_walls->bodies[0].impulse;
    real size = 0;
    for (const real q : got) size = std::max(size, std::abs(q));
    EXPECT_GT(size, 1e-3);
    // The solve leaves 1e-15 of its right-hand side; the sums are of thousands of faces.
    for (std::size_t k = 0; k < got.size(); ++k) EXPECT_NEAR(got[k] + gained[k], 0, 1e-12 * size) << k;
}

TEST("liquid that turns with a body as one does not rub it") {
    const OneThread alone;
    FluidWithFriction<2> r(2e-3);
    const auto& body = r.body();
    for (int a = 0; a < 2; ++a)
        for (std::size_t i = 0; i < r.s.u[a].size(); ++i) {
            const Vec<2> at = r.s.u.face_centre(a, mac::index_of<2>(r.s.u[a].extent(), i));
            r.s.u[a][i] = mac::NoSlipWalls<2>::along(mac::moves_at<2>(a, at - body.at), body.velocity);
        }
    water::SurfaceViscosity<2> viscosity(r.frame, r.s, 1, true);
    viscosity.enforce_bodies(r.s);
    viscosity.apply(r.s, r.all_liquid, r.closed, 1e-4);
    // The box's own sides stop the liquid's way through them; ten cells away that is a part of (dt nu/h^2 = 0.0016)^10.
    for (const real q : r.s.no_slip_walls->bodies[0].impulse) EXPECT_NEAR(q, 0, 1e-12);
}

TEST("a disc without mass is carried and turned by viscous liquid, whatever the step") {
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

TEST("a disc that spins over the liquid feels no friction, and one that floats at rest feels its weight alone") {
    const OneThread alone;
    const std::string over =
        "{ shape = \"sphere\", centre = [0.3, 1.05], radius = 0.12, density = 500.0, spin = [3.0], slip = \"no\", fixed = [\"y\"] }";
    const std::string floats = "{ shape = \"sphere\", centre = [0.8, 0.6], radius = 0.2, density = 500.0, slip = \"no\" }";
    const auto solver = solver_of(sticky(over + ", " + floats, 40, 1e-2, "[0.0, -9.81]", 0.6));
    for (int i = 0; i < 40; ++i) {
        solver->step(0.005);
        EXPECT_EQ(shown(*solver, "viscous_torque", 0, 0), 0.0);
        EXPECT_EQ(shown(*solver, "spin", 0, 0), 3.0);
    }
    const real weight = 500 * pi * 0.04 * 9.81, h = 1.25 / 40;
    EXPECT_NEAR(shown(*solver, "position", 1, 1), 0.6, 0.1 * h);  // as without friction
    EXPECT_LT(std::abs(shown(*solver, "viscous_force", 1, 1)), 1e-2 * weight);
}

TEST("bodies that liquid sticks to continue from a checkpoint bit for bit, and with two threads as with one") {
    const std::string flat = sticky(
        "{ shape = \"box\", min = [0.3, 0.5], max = [0.7, 0.75], density = 700.0, spin = [2.0], slip = \"no\" }, { shape = "
        "\"sphere\", centre = [0.9, 0.3], radius = 0.15, density = 1500.0, slip = \"no\" }, { shape = "
        "\"sphere\", centre = [0.9, 0.8], radius = 0.1, density = 300.0 }",
        24, 1e-2, "[0.0, -9.81]", 0.7);
    const std::string deep = R"(solver = "mac_water"
dim = 3
grid = { cells = [12, 9, 9], size = [0.8, 0.6, 0.6] }
time = { end = 1.0 }
fluid = { density = 1000.0, viscosity = 0.01 }
liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.8, 0.35, 0.6] } ]
effects = { gravity = { g = [0.0, -9.81, 0.0] }, viscosity = { scheme = "implicit" } }
bodies = [ { shape = "box", min = [0.1, 0.25, 0.15], max = [0.35, 0.4, 0.4], density = 600.0, spin = [1.0, 0.5, 0.2], slip = "no" },
           { shape = "capsule", from = [0.5, 0.15, 0.2], to = [0.65, 0.2, 0.35], radius = 0.07, density = 1200.0, slip = "no" } ]
)";
    for (const auto& [text, dim] : {std::pair{flat, 2}, std::pair{deep, 3}}) {
        const std::size_t bodies = dim == 2 ? 3 : 2;
        const auto one = solver_of(text), two = solver_of(text);
        set_threads(1);
        for (int i = 0; i < 10; ++i) one->step(0.006);
        Checkpoint checkpoint;
        one->save(checkpoint);
        two->restore(checkpoint);
        for (int i = 0; i < 3; ++i) {
            set_threads(1);
            one->step(0.006);
            set_threads(2);
            two->step(0.006);
        }
        set_threads(0);
        expect_same_bodies(*one, *two, bodies, dim);
        expect_same_numbers(*one, *two, "water.markers.0");
        for (std::size_t body = 0; body < bodies; ++body) {
            EXPECT_EQ(shown(*one, "viscous_force", 1, body), shown(*two, "viscous_force", 1, body));
            EXPECT_EQ(shown(*one, "viscous_torque", 0, body), shown(*two, "viscous_torque", 0, body));
        }
        EXPECT_NE(shown(*one, "viscous_force", 1, 0), 0.0);
    }
}

}  // namespace friction_in_water_tests
