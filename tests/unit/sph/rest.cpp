// Liquid that begins at rest has the pressure of its weight from the first step on, and other liquid begins without any.
#include "unit/sph/scenes.hpp"

#include "support/test.hpp"

namespace rest_tests {

using namespace weir;

namespace {

constexpr real g = 9.81, rho = 1000;

/// What particles carry against rho g times their depth below `top`, in units of the pressure at the bottom: the largest difference.
template <int D>
real off(sph::SphSolver<D>& solver, real top) {
    real most = 0;
    const auto& fluid = solver.fluid();
    for (int i = 0; i < fluid.count(); ++i)
        most = std::max(most, std::abs(fluid.carried[static_cast<std::size_t>(i)] - rho * g * (top - fluid.position(i)[1])));
    return most / (rho * g * top);
}
template <int D>
real highest(sph::SphSolver<D>& solver) {
    real most = 0;
    for (const real p : solver.fluid().carried) most = std::max(most, p);
    return most;
}

}  // namespace

TEST_IN_2D_AND_3D("a liquid under a flat top between walls begins with the pressure of its weight") {
    sph::SphSolver<D> full(test::sph_box<D>(1, 1, 1));
    EXPECT_LT(off(full, 1.0), 1e-14);  // a product and a difference, rounded
    EXPECT_EQ(full.concern(), "");
    // Periodic sides hold it too, and a solid in the middle takes nothing away.
    sph::SphSolver<D> ring(test::sph_box<D>(1, 1, 1, "", "sides = { x_min = \"periodic\", x_max = \"periodic\" }"));
    EXPECT_LT(off(ring, 1.0), 1e-14);
    const std::string post = D == 2 ? "min = [0.4, 0.0], max = [0.6, 1.5]" : "min = [0.4, 0.0, 0.0], max = [0.6, 1.5, 1.0]";
    sph::SphSolver<D> parted(test::sph_box<D>(1, 1, 1, "", "solids = [ { shape = \"box\", " + post + " } ]"));
    EXPECT_LT(off(parted, 1.0), 1e-14);
}

TEST_IN_2D_AND_3D("liquid that has a free side, or falls, begins without pressure; a top that is not flat is told") {
    sph::SphSolver<D> dam(test::sph_box<D>(0.5, 1, 1));
    EXPECT_EQ(highest(dam), 0);
    EXPECT_EQ(dam.concern(), "");
    sph::SphSolver<D> summed(test::sph_box<D>(1, 1, 1, "density = \"summation\""));
    EXPECT_EQ(highest(summed), 0);
    const std::string slope = D == 2 ? "point = [0.5, 0.8], normal = [-0.3, 1.0]" : "point = [0.5, 0.8, 0.5], normal = [-0.3, 1.0, 0.0]";
    const auto text = [&](const std::string& liquid) {
        return scene::parse(
            fmt::format("solver = \"sph\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 1.0 }}\nfluid = {{ density "
                        "= 1000.0 }}\nliquid = [ {} ]\neffects.gravity = {{ g = {} }}\n",
                        D, D == 2 ? "[8, 12]" : "[8, 12, 8]", D == 2 ? "[1, 1.5]" : "[1, 1.5, 1]", liquid,
                        D == 2 ? "[0, -9.81]" : "[0, -9.81, 0]"),
            "test.toml", {sph::kind().schema});
    };
    sph::SphSolver<D> tilted(text("{ shape = \"plane\", " + slope + " }"));
    EXPECT_EQ(highest(tilted), 0);
    EXPECT_NE(tilted.concern().find("initial.surface"), std::string::npos) << tilted.concern();
    const std::string low = D == 2 ? "min = [0.0, 0.5], max = [1.0, 1.0]" : "min = [0.0, 0.5, 0.0], max = [1.0, 1.0, 1.0]";
    sph::SphSolver<D> falls(text("{ shape = \"box\", " + low + " }"));
    EXPECT_EQ(highest(falls), 0);
}

TEST("two pools of different heights begin each with its own pressure") {
    sph::SphSolver<2> solver(scene::parse(
        "solver = \"sph\"\ndim = 2\ngrid = { cells = [24, 12], size = [3.0, 1.5] }\ntime = { end = 1.0 }\nfluid = { density = 1000.0 }\n"
        "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [1.0, 1.0] }, { shape = \"box\", min = [1.5, 0.0], max = [3.0, 0.5] } ]\n"
        "solids = [ { shape = \"box\", min = [1.0, 0.0], max = [1.5, 1.5] } ]\neffects.gravity = { g = [0, -9.81] }\n",
        "test.toml", {sph::kind().schema}));
    const auto& fluid = solver.fluid();
    for (int i = 0; i < fluid.count(); ++i) {
        const real top = fluid.position(i)[0] < 1.2 ? 1.0 : 0.5;
        EXPECT_NEAR(fluid.carried[static_cast<std::size_t>(i)], rho * g * (top - fluid.position(i)[1]), 1e-9);
    }
}

TEST("the wall below a column ten times as high as wide feels its weight from the first step, and goes on to") {
    sph::SphSolver<2> solver(test::sph_box<2>(0.4, 4.0, 1, "", "", "[8, 84]", "[0.4, 4.2]"));
    const auto deepest = [&] {
        real sum = 0;
        int count = 0;
        for (int i = 0; i < solver.fluid().count(); ++i)
            if (solver.fluid().position(i)[1] < 0.05) sum += solver.fluid().carried[static_cast<std::size_t>(i)], ++count;
        return sum / count;
    };
    const real expected = rho * g * (4.0 - 0.025);
    for (int step = 0; step < 400; ++step) {
        solver.step(solver.advised_dt());
        // The bar: a tenth. Without the start it swings from none to twice the weight.
        ASSERT_NEAR(deepest(), expected, 0.1 * expected) << step;
    }
}

}  // namespace rest_tests
