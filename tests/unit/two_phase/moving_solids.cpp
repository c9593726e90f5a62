// Moving solids among liquid and gas: volumes, stillness, symmetries, closed tanks.
#include "support.hpp"

#include "core/error.hpp"

namespace moving_solid_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

/// A tank with liquid up to y = 0.47 m and the given solids.
template <int D>
std::string tank(const std::string& solids, const std::string& more = "") {
    return test::tank<D>(24, up_to<D>("0.47"), "solids = [ " + solids + " ]\n" + more);
}

template <int D>
std::string ball(const std::vector<std::string>& centre, const std::string& motion) {
    return "{ shape = \"sphere\", centre = " + list(centre, D) + ", radius = 0.15, motion = { " + motion + " } }";
}

template <int D>
std::string constant(const std::vector<std::string>& velocity) {
    return "kind = \"constant\", velocity = " + list(velocity, D);
}

/// Gas in a box [m²; m³], by the fractions of the cells that it covers.
template <int D>
real gas_in(const TwoPhase<D>& solver, const Vec<D>& lo, const Vec<D>& hi) {
    const auto& grid = solver.state().u;
    return grid.cell_volume() * sum_over(solver.fraction().extent(), [&](const Index<D>& I) {
               real covered = 1;
               for (int d = 0; d < D; ++d) {
                   const real first = (lo[d] - grid.origin[d]) / grid.h[d] - I[d], last = (hi[d] - grid.origin[d]) / grid.h[d] - I[d];
                   covered *= std::max(0.0, std::clamp(last, 0.0, 1.0) - std::clamp(first, 0.0, 1.0));
               }
               return covered * (1 - solver.fraction()(I));
           });
}

/// Runs up to time t. Returns the largest sum of both energies.
template <int D>
real run_until(TwoPhase<D>& solver, real t) {
    real most = -infinity;
    while (solver.time() < t) {
        solver.step(std::min(solver.advised_dt(), t - solver.time() + 1e-12));
        EXPECT_LT(mac::max_magnitude(solver.fraction(), 0.5), 0.5 + 1e-7);
        most = std::max(most, integral(solver, "kinetic_energy") + integral(solver, "potential_energy"));
    }
    return most;
}

}  // namespace

// Σ V f is restored by one linear correction, so round-off is left. Cut cells fill as whole cells do, so a step may err by the part of the
// newly wetted or dried cut cells that is in the solid: at most the surface of the ball times h.
TEST_IN_2D_AND_3D(
    "a ball that plunges, emerges or moves along a surface keeps the visible liquid, and corrects less than its skin of cells") {
    for (const auto& [centre_y, velocity] : {std::pair{"0.7", "-0.8"}, {"0.3", "0.8"}, {"0.47", "0.1"}}) {
        TwoPhase<D> solver(two_phase_scene(tank<D>(ball<D>({"0.513", centre_y, "0.36"}, constant<D>({"0.1", velocity, "0.05"})))));
        const real volume = integral(solver, "volume");
        run_until(solver, D == 2 ? 0.4 : 0.1);
        EXPECT_NEAR(integral(solver, "volume"), volume, 1e-14);
        const real skin = (D == 2 ? 2 * pi * 0.15 : 4 * pi * 0.15 * 0.15) / 24;
        EXPECT_LT(integral(solver, "volume_corrections"), skin);
    }
}

// Turned blades cut cells in every way. Their tips move at 0.5 m/s; the energy that they give the liquid in 0.5 s is at most that of all of
// it, 470 kg/m, at twice the tips' speed.
TEST("a blade that rotates in the surface keeps the visible liquid, from any angle and either way") {
    for (const char* angle : {"0.0", "0.5235987755982988"})
        for (const char* rate : {"2.0", "-2.0"}) {
            const std::string blade = fmt::format(
                "{{ shape = \"box\", min = [0.25, 0.4], max = [0.75, 0.5], motion = {{ kind = \"keyframes\", centre = [0.5, 0.45], frames "
                "= [ "
                "{{ t = 0.0, angle = {} }}, {{ t = 10.0, angle = {} }} ] }} }}",
                angle, std::stod(angle) + 10 * std::stod(rate));
            TwoPhase<2> solver(two_phase_scene(tank<2>(blade)));
            const real volume = integral(solver, "volume"), energy = integral(solver, "potential_energy");
            EXPECT_LT(run_until(solver, 0.5) - energy, 0.5 * 470 * 1.0);
            EXPECT_NEAR(integral(solver, "volume"), volume, 1e-14);
        }
}

// The surface in the glass may err by a tenth of a cell; a surface that lags beside cut walls, or is dragged along by them, loses 3%.
TEST_IN_2D_AND_3D("an upturned glass that is pushed into the liquid keeps its gas, wherever its walls cut cells") {
    const int n = D == 2 ? 64 : 32;
    const real half = 0.125, high = 0.325, speed = D == 2 ? 0.2 : 0.4, h = 1.0 / n;
    for (const real shift : {0.0, 0.26 * h, 0.5 * h}) {
        const auto box = [&](real away, real low, real top) {
            const std::string lo = std::to_string(0.5 + shift - away), hi = std::to_string(0.5 + shift + away);
            return "{ shape = \"box\", min = " + list({lo, std::to_string(low), lo}, D) +
                   ", max = " + list({hi, std::to_string(top), hi}, D) + " }";
        };
        const std::string glass = "{ shape = \"difference\", from = " + box(half + 0.08, 0.5, 0.5 + high + 0.08) + ", minus = [ " +
                                  box(half, 0.2, 0.5 + high) + " ], motion = { " + constant<D>({"0.0", std::to_string(-speed), "0.0"}) +
                                  " } }";
        TwoPhase<D> solver(two_phase_scene(tank<D>(glass, "sides = { y_max = { kind = \"outflow\" } }"),
                                           {{"liquid", "[ { shape = \"box\", min = " + list({"-1.0", "-1.0", "-1.0"}, D) +
                                                           ", max = " + list({"2.0", "0.55", "2.0"}, D) + " } ]"},
                                            {"grid.cells", list({std::to_string(n), std::to_string(n), std::to_string(n)}, D)},
                                            {"grid.size", list({"1.0", "1.0", "1.0"}, D)}}));
        const auto gas = [&] {
            Vec<D> lo = Vec<D>::constant(0.5 + shift - half), hi = Vec<D>::constant(0.5 + shift + half);
            lo[1] = 0.5 - speed * solver.time() - 2 * h, hi[1] = lo[1] + high + 2 * h;
            return gas_in(solver, lo, hi);
        };
        const real before = gas();
        run_until(solver, 0.25 / speed);
        EXPECT_NEAR(gas(), before, 0.1 * h * before / high) << "shifted by " << shift / h << " cells";
    }
}

// An oscillating ball plunges into the tank; its corrections are made beside it. The pool in a fixed cup has walls that cut cells, where
// its liquid ends: a surface may err by a tenth of a cell.
TEST("the liquid of a cup stands still while a ball plunges beside it") {
    const int n = 48;
    const std::string scene = tank<2>(
        R"({ shape = "difference", from = { shape = "box", min = [0.1, 0.6], max = [0.4, 0.95] }, minus = [ { shape = "box", min = [0.15, 0.65], max = [0.35, 1.5] } ] },
 { shape = "sphere", centre = [0.7, 0.4], radius = 0.12, motion = { kind = "sinusoidal", amplitude = [0.0, 0.1], frequency = 1.0 } })");
    TwoPhase<2> solver(two_phase_scene(
        scene, {{"liquid",
                 "[ { shape = \"box\", min = [-9.0, -9.0], max = [9.0, 0.4] }, { shape = \"box\", min = [0.15, 0.65], max = [0.35, "
                 "0.8] } ]"},
                {"grid.cells", "[48, 48]"}}));
    const auto pool = [&] { return 0.2 * 0.3 - gas_in<2>(solver, {{0.15, 0.65}}, {{0.35, 0.95}}); };
    const real before = pool();
    EXPECT_NEAR(before, 0.2 * 0.15, 0.2 * 0.1 / n);
    run_until(solver, 3);
    EXPECT_NEAR(pool(), before, 0.2 * 0.1 / n);
}

// Behind a thin solid the continued velocity may be that of a jet on its other side. Liquid at 1 m/s, or the solid at 0 to 1 m/s, bounds
// it; gas beside it does not.
TEST_IN_2D_AND_3D("a face that a solid uncovers has the velocity of the liquid beside it, not what stood in the solid") {
    const auto scene = two_phase_scene(tank<D>(ball<D>({"0.413", "0.5", "0.36"}, constant<D>({"1.0", "0.0", "0.0"}))));
    mac::MacState<D> state(scene, FieldPlan{});
    mac::SolidPlacement<D> placement(geometry::Solids<D>(scene), state);
    two_phase::UncoveredFaces<D> uncovered;
    two_phase::FaceFractions<D> fractions;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        fractions[at] = Grid<real, D>(state.u[a].extent());
        for_each_cell(state.u[a].extent(), [&](const Index<D>& I) {
            const bool liquid = state.u.face_centre(a, I)[1] < 0.45;
            fractions[at](I) = liquid ? 1 : 0;
            state.u[a](I) = state.solid.open[at](I) == 0 ? 50 : liquid ? 1 : -1;
        });
    }
    uncovered.remember(state);
    const auto before = state.solid.open;
    placement.place(state, 0.06);
    uncovered.settle(state, {1000, 1}, fractions);
    int count = 0;
    for (int a = 0; a < D; ++a)
        mac::for_each_free_face(state.u, state.sides, a, [&](const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            if (before[at](I) > 0 || state.solid.open[at](I) == 0) return;
#pragma omp critical
            {
                ++count;
                EXPECT_LE(std::abs(state.u[a](I)), 1) << a;
                if (state.u.face_centre(a, I)[1] < 0.4) {
                    EXPECT_NEAR(state.u[a](I), 1, 2e-3) << a;
                }
            }
        });
    EXPECT_GT(count, 4);
}

// All of the liquid, 470 kg/m, at the speed of the tips, 1.8 m/s. A jet of gas behind an arm may not become one of liquid.
TEST("a paddle gives the liquid no more than the speed of its tips") {
    for (const char* c : {"0.504", "0.511"}) {
        const real middle = std::stod(c);
        const auto bar = [&](real x, real y) {
            return fmt::format("{{ shape = \"box\", min = [{}, {}], max = [{}, {}] }}", middle - x, middle - y, middle + x, middle + y);
        };
        const std::string paddle = "{ shape = \"union\", of = [ " + bar(0.3, 0.03) + ", " + bar(0.03, 0.3) +
                                   " ], motion = { kind = \"rotation\", rate = 6.0, centre = [" + c + ", " + c + "] } }";
        TwoPhase<2> solver(two_phase_scene(tank<2>(paddle), {{"grid.cells", "[32, 32]"}}));
        const real start = integral(solver, "potential_energy");
        EXPECT_LT(run_until(solver, 2) - start, 0.5 * 470 * 1.8 * 1.8) << c;
    }
}

// The tangential velocity of a wall without friction moves nothing. A solid's velocity is that at the middle of a face, at most h/2 (1 − A)
// from the middle of its closed part, so a rotation leaves fluxes of A (1 − A) ω h/2 ≤ ω h/8 in a layer of one cell around the wet half.
TEST_IN_2D_AND_3D("a half-submerged ball that rotates leaves still liquid as still as the fluxes of its cut faces are exact") {
    const real h = 1.0 / 24, wet = D == 2 ? pi * 0.15 : 2 * pi * 0.15 * 0.15;
    for (const char* x : {"0.5", "0.513"})
        for (const real omega : {2.0, -2.0}) {
            const std::string turns =
                fmt::format("kind = \"keyframes\", centre = {}{}, frames = [ {{ t = 0.0 }}, {{ t = 10.0, angle = {} }} ]",
                            list({x, "0.47", "0.36"}, D), D == 3 ? ", axis = [1.0, 0.0, 0.0]" : "", 10 * omega);
            TwoPhase<D> solver(two_phase_scene(tank<D>(ball<D>({x, "0.47", "0.36"}, turns))));
            run_until(solver, D == 2 ? 1.0 : 0.3);
            EXPECT_LT(integral(solver, "kinetic_energy"), 0.5 * 1000 * wet * h * std::pow(omega * h / 8, 2)) << x << ' ' << omega;
        }
}

// A u + (1 − A) u_s is uniform, so the pressure has nothing to do: round-off of a stream of 1 m/s, in the gas over 1000:1.
TEST_IN_2D_AND_3D("a stream that moves with the solid in it stays uniform, wherever the solid cuts cells") {
    const std::vector<std::string> stream{"0.6", "0.35", "0.2"};
    const auto scene = two_phase_scene(tank<D>(ball<D>({"0.513", "0.47", "0.36"}, constant<D>(stream))),
                                       {{"effects", "{}"},
                                        {"grid.periodic", list({"\"x\"", "\"y\"", "\"z\""}, D)},
                                        {"initial.velocity", "{ name = \"constant\", value = " + list(stream, D) + " }"}});
    TwoPhase<D> solver(scene);
    const real volume = integral(solver, "volume");
    for (int step = 0; step < (D == 2 ? 60 : 15); ++step) solver.step(0.01);
    for (int a = 0; a < D; ++a) EXPECT_LT(mac::max_magnitude(solver.state().u[a], std::stod(stream[static_cast<std::size_t>(a)])), 1e-9);
    EXPECT_NEAR(integral(solver, "volume"), volume, 1e-14);
}

// Multigrid visits cells in another order: the tolerance 1e-10 of the solve, over 15 steps.
TEST_IN_2D_AND_3D("a mirrored motion is the mirror image") {
    TwoPhase<D> left(two_phase_scene(tank<D>(ball<D>({"0.413", "0.5", "0.36"}, constant<D>({"0.3", "-0.2", "0.1"})))));
    TwoPhase<D> right(two_phase_scene(tank<D>(ball<D>({"0.587", "0.5", "0.36"}, constant<D>({"-0.3", "-0.2", "0.1"})))));
    for (int step = 0; step < 15; ++step) left.step(0.004), right.step(0.004);
    const int n = left.fraction().extent()[0];
    EXPECT_LT(max_over(left.fraction().extent(),
                       [&](const Index<D>& I) {
                           Index<D> J = I;
                           J[0] = n - 1 - I[0];
                           return std::abs(left.fraction()(I) - right.fraction()(J));
                       }),
              1e-7);
}

TEST_IN_2D_AND_3D("with a moving ball, one thread and three give the same bits, and so does a restored run") {
    expect_reproducible<D>(two_phase_scene(tank<D>(ball<D>({"0.413", "0.5", "0.36"}, constant<D>({"0.3", "-0.2", "0.1"})))), 10, 5);
}

// Gas that is driven from before the ball returns above it. Beside a wall without slip it moves with the wall: in the first cell, half a
// cell or less above it, at more than half of its 0.3 m/s less what a layer of √(νt) = 0.1 m loses; without friction it moves backwards.
TEST_IN_2D_AND_3D("a ball without slip drags both fluids along, and keeps the liquid, with the same bits by threads and after a restart") {
    const auto scene = [](const std::string& slip) {
        const std::string ball_at = "{ shape = \"sphere\", centre = " + list({"0.4", "0.5", "0.36"}, D) + ", radius = 0.15, slip = \"" +
                                    slip + "\", motion = { " + constant<D>({"0.3", "0.0", "0.0"}) + " } }";
        return two_phase_scene(tank<D>(ball_at), {{"effects.viscosity", "{}"}, {"fluid.viscosity", "0.1"}, {"gas.viscosity", "0.1"}});
    };
    TwoPhase<D> drags(scene("no")), slips(scene("free"));
    const real volume = integral(drags, "volume");
    for (int step = 0; step < 20; ++step) drags.step(0.005), slips.step(0.005);
    EXPECT_NEAR(integral(drags, "volume"), volume, 1e-14);
    Index<D> above = Index<D>::constant(8);
    above[0] = 10, above[1] = 15;
    EXPECT_GT(drags.state().u[0](above), 0.05);
    EXPECT_LT(slips.state().u[0](above), 0);
    expect_reproducible<D>(scene("no"), 6, 3);
}

TEST("a piston in a closed tank is refused, and stops the run if it begins to move later; with an open side it lifts the liquid") {
    const std::string piston = "{ shape = \"box\", min = [-2.0, -1.0], max = [0.23, 2.0], motion = { ";
    const std::string pushes = piston + "kind = \"constant\", velocity = [0.1, 0.0] } }";
    try {
        TwoPhase<2> solver(two_phase_scene(tank<2>(pushes)));
        ADD_FAILURE() << "accepted";
    } catch (const BadInput& bad) {
        for (const char* part : {"shrinks", "incompressible", "outflow"})
            EXPECT_NE(std::string(bad.what()).find(part), std::string::npos) << bad.what();
    }
    TwoPhase<2> later(two_phase_scene(
        tank<2>(piston + "kind = \"keyframes\", frames = [ { t = 0.1, offset = [0.0, 0.0] }, { t = 1.1, offset = [0.1, 0.0] } ] } }")));
    EXPECT_THROW(run_until(later, 0.3), NumericalFailure);
    TwoPhase<2> open(two_phase_scene(tank<2>(pushes, "sides = { y_max = { kind = \"outflow\" } }")));
    const real volume = integral(open, "volume"), height = integral(open, "centre_y");
    run_until(open, 0.5);
    EXPECT_NEAR(integral(open, "volume"), volume, 1e-14);
    // 0.47 m in 0.77 m is 0.503 m in 0.72 m; half of the rise, within half of it for the waves
    EXPECT_NEAR(integral(open, "centre_y") - height, 0.5 * (0.47 * 0.77 / 0.72 - 0.47), 0.25 * (0.47 * 0.77 / 0.72 - 0.47));
}

}  // namespace moving_solid_tests
