// Smoke beside a body that moves: what is alike everywhere stays so, and what is taken out of the body is counted. Fluxes alone piled it up
// in the cells that the body cuts, a hundredfold within one swing.

#include "support/grid_solvers.hpp"
#include "support/test.hpp"

using namespace weir;
using namespace weir::flow;

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
            (D == 2 ? "[1.0, 1.0]" : "[1.0, 1.0, 1.0]") + " }\ntime = { end = 1.0 }\nsolids = [ { shape = \"sphere\", centre = " + centre +
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
