// No-slip walls of solids are met where they are: at any distance from the grid's lines, along any axis, on either side,
// turning or not; and what it rubs off them is in balance with what drives it.
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

#include <numbers>

namespace solid_walls_tests {

using namespace weir;
using namespace weir::smoke;

namespace {

real integral_of(const Solver& solver, const std::string& name) {
    for (const Integral& i : solver.integrals())
        if (i.name == name) return i.value;
    return not_applicable;
}

std::string vector_of(int dim, real other, int axis, real along) {
    std::string text = "[";
    for (int d = 0; d < dim; ++d) text += (d > 0 ? ", " : "") + std::to_string(d == axis ? along : other);
    return text + "]";
}

constexpr real nu = 0.1;

/// Flow along one axis between a side of the domain and a solid's face, 1 + offset h away from it across the next; driven so that its
/// largest speed is 1. `far`: the solid stands at the lower end, and the side at the upper one.
struct Gap {
    int dim, n;
    real offset;
    int along;
    bool far;
    int across() const { return (along + 1) % dim; }
    real h() const { return 1.0 / n; }
    real width() const { return 1 + offset * h(); }
    real push() const { return 8 * nu / (width() * width()); }
    std::string scene(const std::string& scheme, const std::string& slip, const std::string& rest) const {
        std::string cells = "[", size = "[", periodic = "[";
        for (int d = 0; d < dim; ++d) {
            const int count = d == across() ? n + 4 : 4;
            cells += (d > 0 ? ", " : "") + std::to_string(count), size += (d > 0 ? ", " : "") + std::to_string(count * h());
            if (d != across()) periodic += (periodic.size() > 1 ? ", \"" : "\"") + std::string(1, "xyz"[d]) + "\"";
        }
        const real length = (n + 4) * h(), from = far ? -1 : width(), to = far ? length - width() : length + 1;
        const std::string side = std::string(1, "xyz"[across()]) + (far ? "_max" : "_min");
        return "solver = \"mac\"\ndim = " + std::to_string(dim) + "\ngrid = { cells = " + cells + "], size = " + size +
               "], periodic = " + periodic + "] }\ntime = { end = 1.0 }\nfluid = { viscosity = 0.1 }\nsides = { " + side +
               " = { kind = \"wall\", slip = \"" + slip +
               "\" } }\nsolids = [ { shape = \"box\", min = " + vector_of(dim, -9, across(), from) +
               ", max = " + vector_of(dim, 9, across(), to) + ", slip = \"" + slip + "\" } ]\neffects = { viscosity = { scheme = \"" +
               scheme + "\" }, gravity = { g = " + vector_of(dim, 0, along, push()) + " } }\n" + rest;
    }
    /// Distance of a face of the flow from the side.
    template <int D>
    real from_side(const MacVelocity<D>& u, const Index<D>& I) const {
        const real x = u.face_centre(along, I)[across()];
        return far ? (n + 4) * h() - x : x;
    }
};

/// Largest error of the steady flow in a gap. Implicit steps of ten times the decay time of the slowest mode, 1/(ν π²), each leave a tenth
/// of what is not steady.
template <int D>
real poiseuille_error(const Gap& gap) {
    FlowSolver<D> flow(test::mac_scene(gap.scene("implicit", "no", "")));
    for (int i = 0; i < 8; ++i) flow.step(10);
    const auto& u = flow.state().u;
    real error = 0;
    for_each_cell(u[gap.along].extent(), [&](const Index<D>& I) {
        const real y = gap.from_side(u, I), w = gap.width();
        error = std::max(error, std::abs(u[gap.along](I) - (y < w ? 4 * y * (w - y) / (w * w) : 0)));
    });
    real area = 1;  // of the wall
    for (int d = 0; d < D; ++d) area *= d == gap.across() ? 1 : 4 * gap.h();
    const real friction = integral_of(flow, std::string("solid_friction_force_") + "xyz"[gap.along]);
    EXPECT_NEAR(friction, gap.push() * gap.width() / 2 * area, 0.01 * friction)
        << "each wall bears half of the push; the profile is off by that much at 8 cells";
    EXPECT_NEAR(integral_of(flow, std::string("solid_force_") + "xyz"[gap.along]), friction, 1e-9);
    return error;
}

}  // namespace

// The symmetric form and a side of the domain both err by u''h²/8 at most: 8/8/16² = 0.4% at 16 cells.
TEST("Poiseuille flow beside the face of a solid is of second order wherever the face is") {
    set_threads(1);
    for (const int along : {0, 1})
        for (const bool far : {false, true})
            for (const real offset : {0.0, 0.01, 0.5, -0.01}) {
                const real coarse = poiseuille_error<2>({2, 8, offset, along, far}),
                           fine = poiseuille_error<2>({2, 16, offset, along, far});
                EXPECT_LE(fine, 0.005) << "along " << along << ", offset " << offset << (far ? ", far" : "");
                EXPECT_GE(std::log2(coarse / fine), 1.8) << "along " << along << ", offset " << offset << (far ? ", far" : "");
            }
    for (const int along : {0, 1, 2}) EXPECT_LE(poiseuille_error<3>({3, 8, 0.3, along, false}), 0.02) << "along " << along;
}

TEST_IN_2D_AND_3D("a free-slip solid does not hold what flows along it, in any scheme") {
    set_threads(1);
    for (const char* scheme : {"implicit", "crank-nicolson", "explicit"})
        for (const char* advection : {"semi_lagrangian", "maccormack", "conservative"}) {
            const Gap gap{D, 8, 0.3, 0, false};
            FlowSolver<D> flow(test::mac_scene(gap.scene(scheme, "free", "scheme = { advection = \"" + std::string(advection) + "\" }\n")));
            constexpr real dt = 0.02;
            for (int i = 0; i < 5; ++i) flow.step(dt);
            const auto& u = flow.state().u;
            real slowest = 1;
            for_each_cell(u[0].extent(), [&](const Index<D>& I) {
                if (flow.state().solid.open[0](I) > 0) slowest = std::min(slowest, u[0](I));
            });
            EXPECT_NEAR(slowest, 5 * dt * gap.push(), 1e-7) << scheme << ", " << advection << ": falls freely, to six digits";
        }
}

// The profile is linear, which the symmetric form reproduces exactly wherever the wall is. The slowest mode has decayed by
// e^(−ν (π/w)² t), below e^(−20) of 2/π, after 32 s; pressures are solved for to 1e-8.
TEST_IN_2D_AND_3D("Couette flow beside a solid that moves along its face is exact in every viscosity scheme, wherever the face is") {
    set_threads(1);
    for (const char* scheme : {"explicit", "crank-nicolson", "implicit"})
        for (const int along : {0, 1})
            for (const real offset : {0.0, 0.55, 0.9}) {  // a node is 0.5 h, 0.05 h or 0.4 h from the face
                const Gap gap{D, 4, offset, along, false};
                std::string text = gap.scene(scheme, "no", "");
                const std::string slip = "slip = \"no\" } ]", g = "gravity = { g = ";
                text.insert(text.find(slip), "motion = { kind = \"constant\", velocity = " + vector_of(D, 0, along, 1) + " }, ");
                text.erase(text.find(", " + g), text.find(" } }\n", text.find(g)) + 2 - text.find(", " + g));
                FlowSolver<D> flow(test::mac_scene(text));
                for (int i = 0; i < 400; ++i) flow.step(0.08);
                const auto& u = flow.state().u;
                real error = 0;
                for_each_cell(u[along].extent(), [&](const Index<D>& I) {
                    const real y = gap.from_side(u, I);
                    if (y < gap.width()) error = std::max(error, std::abs(u[along](I) - y / gap.width()));
                });
                EXPECT_LT(error, 1e-6) << scheme << ", along " << along << ", offset " << offset;
            }
}

// Between a solid disc that turns and a ring at rest u = A r + B/r (Couette). The symmetric form errs by h²/8 |u''| ≤ 0.7 h² ω at most:
// 0.7% of the rim's speed at 10 cells, 0.2% at 20; twice as much is allowed for what crosses the walls at other angles.
TEST("Taylor-Couette flow beside a solid that turns is right within 1.5% at 10 cells per gap") {
    set_threads(1);
    constexpr real omega = 1, h = 0.05;
    for (const char* advection : {"maccormack", "conservative"}) {
        FlowSolver<2> flow(test::mac_scene(
            "solver = \"mac\"\ndim = 2\ngrid = { cells = [44, 44], size = [2.2, 2.2] }\ntime = { end = 1.0 }\nfluid = { viscosity = 0.1 }\n"
            "solids = [ { shape = \"sphere\", centre = [1.1, 1.115], radius = 0.5, slip = \"no\", motion = { kind = \"rotation\", rate = "
            "1.0 } },"
            " { shape = \"difference\", from = { shape = \"box\", min = [-9.0, -9.0], max = [9.0, 9.0] },"
            " minus = [ { shape = \"sphere\", centre = [1.1, 1.115], radius = 1.0 } ], slip = \"no\" } ]\n"
            "effects = { viscosity = {} }\nscheme = { advection = \"" +
            std::string(advection) + "\" }\n"));
        for (int i = 0; i < 60; ++i) flow.step(0.05);  // 3 s: diffusion across the gap takes 0.25/(0.1 π²) s
        const auto& u = flow.state().u;
        const real a = -omega * 0.25 / 0.75, b = omega * 0.25 / 0.75;
        real error = 0;
        for (int axis = 0; axis < 2; ++axis)
            for_each_cell(u[axis].extent(), [&](const Index<2>& I) {
                const Vec<2> r = u.face_centre(axis, I) - Vec<2>{1.1, 1.115};
                const real away = norm(r);
                if (away < 0.5 + 0.5 * h || away > 1 - 0.5 * h) return;
                const real speed = (a * away + b / away) / away;
                error = std::max(error, std::abs(u[axis](I) - speed * (axis == 0 ? -r[1] : r[0])));
            });
        EXPECT_LE(error, 0.015 * omega * 0.5) << advection;
        // The torques of both walls are 4π μ B and its opposite, 0.42 N: what is left of them is the error of the slopes at the walls, by
        // which the profile turns over a cell: h u/u = 0.05 · 2/0.5 at the inner wall, a fifth, and two thirds of that are corrected.
        EXPECT_NEAR(integral_of(flow, "solid_torque_z"), 0, 0.08 * 4 * std::numbers::pi * 0.1 * b) << advection;
    }
}

// Stokes' second problem, over a plate that swings in its plane: u = U cos(ωt − y/δ) e^(−y/δ) from the plate on, δ = √(2ν/ω) (Batchelor
// 1967, sec. 4.3). With five cells per δ the symmetric form errs by U h²/(8 δ²) ∂²u/∂η² = 2 U/(8 · 25) = 1% at most, as much is allowed for
// time: Crank-Nicolson with 40 steps a period errs by (ω dt)²/12 = 0.2%, semi-Lagrangian's by whatever it does to nothing that flows
// across.
TEST("the layer on a plate that swings in its plane is right within 2% at 5 cells per depth") {
    set_threads(1);
    constexpr real delta = 1, viscosity = 0.5, omega = 2 * viscosity, period = 2 * std::numbers::pi / omega;
    for (const char* scheme : {"crank-nicolson", "implicit"})
        for (const char* advection : {"semi_lagrangian", "maccormack", "conservative"})
            for (const real face : {0.4, 0.5, 0.402}) {
                FlowSolver<2> flow(test::mac_scene(
                    "solver = \"mac\"\ndim = 2\ngrid = { cells = [4, 40], size = [0.8, 8.0], periodic = [\"x\"] }\ntime = { end = 1.0 "
                    "}\nfluid = { "
                    "viscosity = 0.5 }\nsolids = [ { shape = \"box\", min = [-9.0, -9.0], max = [9.0, " +
                    std::to_string(face) + "], slip = \"no\", motion = { kind = \"sinusoidal\", amplitude = [1.0, 0.0], frequency = " +
                    std::to_string(omega / (2 * std::numbers::pi)) + " } } ]\neffects = { viscosity = { scheme = \"" + scheme +
                    "\" } }\nscheme = { advection = \"" + advection + "\" }\n"));
                constexpr int steps = 160;
                const bool first_order = std::string(scheme) == "implicit";
                const int finer = first_order ? 4 : 1;
                for (int i = 0; i < steps * finer; ++i) flow.step(4 * period / (steps * finer));
                const auto& u = flow.state().u;
                real error = 0;
                for_each_cell(u[0].extent(), [&](const Index<2>& I) {
                    const real y = (u.face_centre(0, I)[1] - face) / delta, t = flow.time();
                    if (y > 0) error = std::max(error, std::abs(u[0](I) - omega * std::cos(omega * t - y) * std::exp(-y)));
                });
                EXPECT_LE(error, (first_order ? 0.03 : 0.02) * omega) << scheme << ", " << advection << ", face at " << face;
            }
}

// Where the temperature grows along an insulated wall nothing flows through it: the open parts of a cell's faces close with the wall. Faces
// that are open by less than a hundredth count as closed. Counted as whole, cut cells warmed by half of κ dt/h of the slope.
TEST_IN_2D_AND_3D("heat that is spread evenly along an oblique wall stays where it is") {
    set_threads(1);
    constexpr real kappa = 0.01, dt = 0.01, h = 1.0 / 16;
    const std::string normal = D == 2 ? "[-0.6, 0.8]" : "[-0.48, 0.8, -0.36]", along = D == 2 ? "[0.8, 0.6]" : "[0.8, 0.48, 0.0]";
    FlowSolver<D> flow(test::mac_scene(test::unit_box(
        D, 16,
        "solids = [ { shape = \"plane\", point = " + test::list(D, "0.513") + ", normal = " + normal +
            " } ]\ninitial = { temperature = { name = \"linear\", value = 0.0, gradient = " + along + ", at = " + test::list(D, "0.0") +
            " } }\neffects = { diffusion = { temperature = 0.01, scheme = \"explicit\" } }\nscheme = { advection = \"conservative\" }\n")));
    const Grid<real, D> before = *flow.state().find("temperature");
    flow.step(dt);
    const Grid<real, D>& after = *flow.state().find("temperature");
    real most = 0;
    for_each_cell(before.extent(), [&](const Index<D>& I) {
        for (int d = 0; d < D; ++d)
            if (I[d] < 2 || I[d] > 13) return;
        if (flow.state().cells(I) == poisson::Cell::fluid) most = std::max(most, std::abs(after(I) - before(I)));
    });
    EXPECT_LE(most, 0.01 * kappa * dt / h);
}

// A fluid that turns with a solid as one is not strained: no friction, no torque, though the velocity of the wall has a slope.
TEST_IN_2D_AND_3D("fluid and solid that turn as one do not rub") {
    set_threads(1);
    const std::string middle = test::list(D, "0.52"), axis = D == 2 ? "" : ", axis = [0.0, 0.0, 1.0]";
    FlowSolver<D> flow(test::mac_scene(test::unit_box(D, 16,
                                                      "fluid = { viscosity = 0.1 }\nsolids = [ { shape = \"sphere\", centre = " + middle +
                                                          ", radius = 0.23, slip = \"no\", motion = { kind = \"rotation\", rate = 2.0" +
                                                          axis + " } } ]\neffects = { viscosity = {} }\n")));
    flow.step(1e-9);
    auto& s = flow.state();
    for (int a = 0; a < D; ++a)
        for_each_cell(s.u[a].extent(), [&](const Index<D>& I) {
            const Vec<D> r = s.u.face_centre(a, I) - Vec<D>::constant(0.52);
            s.u[a](I) = a == 0 ? -2 * r[1] : a == 1 ? 2 * r[0] : 0;
        });
    EXPECT_NEAR(integral_of(flow, "solid_friction_torque_z"), 0, 1e-12);
    EXPECT_NEAR(integral_of(flow, "solid_friction_force_x"), 0, 1e-12);
}

// Central fluxes and a projection do no work, upwind ones take some, and walls that let nothing through do none. With fluxes of whole faces
// the energy of this had no bound.
TEST_IN_2D_AND_3D("conservative advection beside a solid does not feed the flow") {
    set_threads(1);
    for (const char* shape : {"sphere", "box"}) {
        const std::string solid = std::string(shape) == "sphere"
                                      ? "shape = \"sphere\", centre = " + test::list(D, "0.51") + ", radius = 0.22"
                                      : "shape = \"box\", min = " + test::list(D, "0.31") + ", max = " + test::list(D, "0.69");
        FlowSolver<D> flow(test::mac_scene(test::unit_box(D, 16,
                                                          "solids = [ { " + solid +
                                                              " } ]\ninitial = { velocity = { name = \"random\", speed = 1.0 } }\n"
                                                              "scheme = { advection = \"conservative\" }\n")));
        flow.step(1e-6);
        const real first = integral_of(flow, "kinetic_energy");
        for (int i = 0; i < 150; ++i) flow.step(std::min(0.5 * flow.advised_dt(), 0.02));
        EXPECT_LE(integral_of(flow, "kinetic_energy"), first) << shape;
    }
}

}  // namespace solid_walls_tests
