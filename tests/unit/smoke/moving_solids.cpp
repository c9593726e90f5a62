// Smoke beside a body that moves: what is alike everywhere stays so, and what is taken out of the body is counted. Fluxes alone piled it up
// in the cells that the body cuts, a hundredfold within one swing.

#include "support/grid_solvers.hpp"
#include "support/test.hpp"

namespace moving_solids_tests {

using namespace weir;
using namespace weir::smoke;

namespace {

real integral_of(const Solver& solver, const std::string& name) {
    for (const Integral& i : solver.integrals())
        if (i.name == name) return i.value;
    return not_applicable;
}

}  // namespace

TEST_IN_2D_AND_3D("uniform smoke and temperature stay so beside a moving body, and the smoke that it covers is counted") {
    const std::string centre = D == 2 ? "[0.4, 0.5]" : "[0.4, 0.5, 0.5]", path = D == 2 ? "[0.5, 0.0]" : "[0.5, 0.0, 0.0]";
    for (const std::string advection : {"conservative", "maccormack", "semi_lagrangian"}) {
        FlowSolver<D> flow(test::mac_scene(
            "solver = \"mac\"\ndim = " + std::to_string(D) + "\ngrid = { cells = " + (D == 2 ? "[24, 24]" : "[16, 16, 16]") + ", size = " +
            (D == 2 ? "[1.0, 1.0]" : "[1.0, 1.0, 1.0]") + " }\ntime = { end = 0.5 }\nsolids = [ { shape = \"sphere\", centre = " + centre +
            ", radius = 0.2, motion = { kind = \"constant\", velocity = " + path +
            " } } ]\ninitial = { smoke = { name = \"constant\", value = 1.0 }, temperature = { name = \"constant\", value = 300.0 } }\n"
            "scheme = { advection = \"" +
            advection + "\" }\n"));
        const real first = integral_of(flow, "total_smoke");
        EXPECT_EQ(integral_of(flow, "smoke_removed"), 0) << "what was put inside was never there";
        for (int step = 0; step < 20; ++step) flow.step(0.01);
        const real held = integral_of(flow, "total_smoke"), removed = integral_of(flow, "smoke_removed");
        const real sweeps = 0.1 * (D == 2 ? 2 * 0.2 : pi * 0.04), h = flow.state().u.h[0];
        // Cells wholly inside are up to a diagonal fewer all around: between what bodies of radius R and that much less sweep.
        EXPECT_LE(removed, sweeps) << advection;
        EXPECT_GE(removed, sweeps * std::pow(1 - std::sqrt(D) * h / 0.2, D - 1)) << advection;
        constexpr real tolerance = 1e-8;  // of the pressure: what is left of divergence gathers or thins what is carried
        real most = 0, least = 1, hottest = 0, coldest = 300;
        for_each_cell(flow.state().extent(), [&](const Index<D>& I) {
            if (flow.state().cells(I) != poisson::Cell::fluid) return;
            const real q = (*flow.state().find("smoke"))(I), t = (*flow.state().find("temperature"))(I);
            most = std::max(most, q), least = std::min(least, q), hottest = std::max(hottest, t), coldest = std::min(coldest, t);
        });
        EXPECT_LE(most, 1 + tolerance) << advection;
        EXPECT_NEAR(hottest, 300, 300 * tolerance) << advection;
        EXPECT_NEAR(coldest, 300, 300 * tolerance) << advection;
        if (advection != "conservative") continue;
        EXPECT_GE(least, 1 - tolerance);
        EXPECT_NEAR(held, first - removed + integral_of(flow, "smoke_continued"), tolerance * first);
    }
}

namespace {

std::string told(const std::string& scene) {
    try {
        FlowSolver<2> flow(test::mac_scene(scene));
    } catch (const BadInput& error) {
        return error.what();
    }
    return "accepted";
}

std::string closed_box(const std::string& solids, const std::string& more = "") {
    return "solver = \"mac\"\ndim = 2\ngrid = { cells = [32, 16], size = [2.0, 1.0] }\ntime = { end = 1.0 }\nsolids = [ " + solids +
           " ]\n" + more;
}

}  // namespace

TEST("solids that change the room of a closed box are refused with the time and the rate; those that only stir it are not") {
    const std::string piston = "{ shape = \"box\", min = [-2.0, -0.1], max = [0.25, 1.1], motion = { kind = ";
    const auto expect = [](const std::string& text, const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << text; };
    expect(told(closed_box(piston + "\"constant\", velocity = [0.5, 0.0] } }")), "shrinks by 0.5 m^2/s");
    expect(told(closed_box(piston + "\"constant\", velocity = [0.5, 0.0] } }", "sides = { x_max = \"outflow\" }\n")), "accepted");
    // It begins to move late, and the time is told.
    expect(told(closed_box(piston + "\"keyframes\", frames = [ { t = 0.5 }, { t = 1.0, offset = [0.1, 0.0] } ] } }")), "t = 0.53125 s");
    // Between two rooms: what one gains the other loses.
    expect(told(closed_box(
               "{ shape = \"box\", min = [0.9, -0.1], max = [1.1, 1.1], motion = { kind = \"constant\", velocity = [0.1, 0.0] } }")),
           "by 0.1 m^2/s");
    // A rotor, a mover, and a plate that slides through both walls along itself.
    expect(told(closed_box("{ shape = \"box\", min = [0.7, 0.45], max = [1.3, 0.55], motion = { kind = \"rotation\", rate = 3.0 } }")),
           "accepted");
    expect(told(closed_box(
               "{ shape = \"sphere\", centre = [1.0, 0.5], radius = 0.21, motion = { kind = \"sinusoidal\", amplitude = [0.3, 0.1], "
               "frequency = 1.0 } }")),
           "accepted");
    expect(told(closed_box(
               "{ shape = \"box\", min = [-9.0, 0.4], max = [9.0, 0.62], motion = { kind = \"constant\", velocity = [1.0, 0.0] } }")),
           "accepted");
}

TEST("a solid that moves through a periodic side leaves the flow that it leaves half a period on") {
    const auto run = [](real x) {
        auto flow = std::make_unique<FlowSolver<2>>(
            test::mac_scene("solver = \"mac\"\ndim = 2\ngrid = { cells = [32, 16], size = [2.0, 1.0], periodic = [\"x\"] }\ntime = { end = "
                            "1.0 }\nsolids = [ { shape = "
                            "\"sphere\", centre = [" +
                            std::to_string(x) + ", 0.45], radius = 0.17, motion = { kind = \"constant\", velocity = [1.0, 0.1] } } ]\n"));
        for (int step = 0; step < 40; ++step) flow->step(0.0125);
        return flow;
    };
    const auto across = run(1.75), clear = run(0.75);  // the first goes through the side at 2 m
    real apart = 0, fastest = 0;
    for (int a = 0; a < 2; ++a)
        for_each_cell(across->state().extent(), [&](const Index<2>& I) {
            Index<2> J = I;
            J[0] = (I[0] + 16) % 32;
            if (across->state().solid.open[static_cast<std::size_t>(a)](I) == 0) return;
            apart = std::max(apart, std::abs(across->state().u[a](I) - clear->state().u[a](J)));
            fastest = std::max(fastest, std::abs(clear->state().u[a](J)));
        });
    // Faces, cells and the pressure repeat to round-off. What is continued into a solid for interpolation does not reach across the side:
    // faces beside it differ by up to 0.8% of the fastest flow.
    EXPECT_GT(fastest, 0.2);
    EXPECT_LT(apart, 0.02 * fastest);
}

}  // namespace moving_solids_tests
