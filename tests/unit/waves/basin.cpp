#include "unit/waves/support.hpp"

namespace basin_tests {

using namespace weir;
using namespace weir::waves;
using weir::test::ask;
using weir::test::values_of;
using weir::test::wave_scene;

TEST("one mode of a basin swings as linear theory says, at every point of the grid") {
    Waves solver(wave_scene(2, "[64, 10]", "[8.0, 10.0]",
                            "waves = \"basin\"\nliquid = [ { shape = \"wave\", level = -3.0, amplitude = 0.05, wavelength = 8.0 } ]"));
    const real k = 2 * pi / 8, depth = 2, omega = std::sqrt(9.81 * k * std::tanh(k * depth)), t = 1.7;
    solver.step(t);
    for (const real x : {0.0, 1.1, 4.0, 7.3}) {
        // the liquid's surface is found to 60 halvings of a cell, at the middles of cells: the wave is sampled exactly
        EXPECT_NEAR(ask<1>(solver, "surface", {{x, 0, 0}})[0], -3 + 0.05 * std::cos(k * x) * std::cos(omega * t), 1e-12);
        const auto u = ask<2>(solver, "velocity", {{x, -4.0, 0}});
        const real rate = -0.05 * omega * std::sin(omega * t);
        EXPECT_NEAR(u[0], -rate * std::sin(k * x) * std::cosh(k * 1.0) / std::sinh(k * depth), 1e-12);
        EXPECT_NEAR(u[1], rate * std::cos(k * x) * std::sinh(k * 1.0) / std::sinh(k * depth), 1e-12);
    }
}

TEST("fields by cosine transforms are the plain sums over the modes, in a basin of two directions") {
    Waves solver(wave_scene(3, "[20, 6, 14]", "[10.0, 10.0, 7.0]",
                            "waves = \"basin\"\nliquid = [ { shape = \"box\", min = [-1.0, -6.0, -1.0], max = [11.0, -2.0, 8.0] }, { shape "
                            "= \"sphere\", centre = "
                            "[3.0, -2.3, 4.0], radius = 1.5 } ]"));
    solver.step(0.8);
    const FieldSet fields = solver.fields();
    const GridView& g = fields.grid;
    for (const auto& [i, j, k] : {std::array{0, 0, 0}, {7, 3, 9}, {19, 2, 13}}) {
        const Vec<3> x{
            {g.origin[0] + (i + 0.5) * g.spacing[0], g.origin[1] + (j + 0.5) * g.spacing[1], g.origin[2] + (k + 0.5) * g.spacing[2]}};
        const auto at = static_cast<std::size_t>(i + 20 * (j + 6 * k));
        EXPECT_NEAR(fields.find("level_set")->data[0][at], ask<1>(solver, "level_set", x)[0], 1e-12);
        for (std::size_t a = 0; a < 3; ++a)
            EXPECT_NEAR(fields.find("", "velocity")->data[a][at], ask<3>(solver, "velocity", x)[a], 1e-11) << a;
    }
}

TEST("a basin begins as its liquid stands, keeps its water, and nothing passes its walls") {
    Waves solver(wave_scene(2, "[50, 1]", "[10.0, 10.0]",
                            "waves = \"basin\"\nliquid = [ { shape = \"box\", min = [-1.0, -6.0], max = [11.0, -2.0] }, { shape = "
                            "\"sphere\", centre = [3.0, -2.3], "
                            "radius = 1.5 } ]"));
    const auto first = values_of(solver, "surface");
    EXPECT_NEAR(first[14], -2.3 + std::sqrt(1.5 * 1.5 - 0.1 * 0.1), 1e-9);  // x = 2.9
    EXPECT_NEAR(first[40], -2, 1e-9);
    const auto mean = [&] { return solver.integrals()[0].value; };
    const real level = mean();
    solver.step(5.3);
    EXPECT_NEAR(mean(), level, 1e-13);
    EXPECT_NEAR((ask<2>(solver, "velocity", {{0, -3, 0}})[0]), 0, 1e-15);
    EXPECT_NEAR((ask<2>(solver, "velocity", {{10, -3, 0}})[0]), 0, 1e-12);
}

}  // namespace basin_tests
