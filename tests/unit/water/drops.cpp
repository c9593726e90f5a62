// Surface tension on drops: the curvature of circles and spheres, rest off the grid's middle, swings that keep their energy.
#include "support.hpp"
#include "water/curvature.hpp"

#include <cmath>

namespace weir::water::drops_tests {

namespace {

/// Liquid in a box of side 1, ρ = σ = 1, no gravity.
std::string free_liquid(const std::string& shape, int cells, const std::string& scheme) {
    return fmt::format(R"(solver = "mac_water"
dim = 2
grid = {{ cells = [{0}, {0}], size = [1.0, 1.0] }}
time = {{ end = 9.0 }}
fluid = {{ density = 1.0 }}
liquid = [ {{ {1} }} ]
effects = {{ surface_tension = {{ sigma = 1.0 }} }}
scheme = {{ {2} }}
)",
                       cells, shape, scheme);
}

/// Largest error of κ R/(D − 1) over the cells beside the surface of circles or spheres of `radius` cells, off the grid's lines by thirds.
template <int D>
real worst_curvature(int n, real radius) {
    Water<D> box(
        test::water_scene(fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
liquid = [ {{ shape = "sphere", centre = {}, radius = {} }} ]
)",
                                      D, test::list({std::to_string(n), std::to_string(n), std::to_string(n)}, D),
                                      test::list({"1.0", "1.0", "1.0"}, D), test::list({"0.51", "0.495", "0.507"}, D), radius / n)));
    const auto& surface = box.surface();
    const Frame<D> frame(box.state().u, box.state().sides);
    real worst = 0;
    for (std::size_t i = 0; i < surface.layer_end(1); ++i)
        worst = std::max(worst, std::abs(curvature_near(surface.phi, frame, surface.band()[i]) * radius / n / (D - 1) - 1));
    return worst;
}

/// Widths of the liquid along x and y: from where its surface crosses the box's middle lines.
real stretch(const Water<2>& water) {
    const auto& phi = water.surface().phi;
    const int n = phi.extent()[0];
    real sum = 0;
    for (int a = 0; a < 2; ++a)
        for (int i = 0; i + 1 < n; ++i)
            for (const int middle : {n / 2 - 1, n / 2}) {
                Index<2> I{{middle, middle}};
                I[a] = i;
                const real here = phi(I), next = phi(I + e<2>(a));
                if ((here < 0) != (next < 0)) sum += (a == 0 ? 1 : -1) * (here < 0 ? 1 : -1) * (i + here / (here - next)) / n;
            }
    return sum;
}

}  // namespace

// The fit is of second order: a parabola for an arc over w = 2.2 cells either way, 2.5 in 3D, misses (w h/R)²/4 at most, 2% and 2.5% on 8
// cells a radius, and a quarter of that on 16, where a third is asked for.
TEST_IN_2D_AND_3D("curvature of circles and spheres is of second order") {
    set_threads(1);
    const real coarse = worst_curvature<D>(24, 8), fine = worst_curvature<D>(44, 16);
    const real bound = D == 2 ? 0.02 : 0.025;
    EXPECT_LT(coarse, bound);
    EXPECT_LT(fine, bound / 3);
}

// Where no surface crosses the window, second differences of the distance are all there is: of a ball's, κ = (D − 1)/r of the ball through
// the cell. They err by h² |x|⁻² times a fourth derivative over 12, of order 1: 2 (h/r)² is allowed for.
TEST_IN_2D_AND_3D("away from the surface curvature is that of the distance's second differences") {
    set_threads(1);
    const MacVelocity<D> u(replicated(Index<D>::constant(32)), Vec<D>::constant(1.0 / 32), Vec<D>{});
    const Frame<D> frame(u, geometry::Sides<D>());
    Grid<real, D> phi(u.cells);
    const Vec<D> middle = Vec<D>::constant(0.51);
    for_each_cell(u.cells, [&](const Index<D>& I) { phi(I) = norm(frame.centre(I) - middle) - 0.15; });
    int slanted = 0;
    for_each_cell(u.cells, [&](const Index<D>& I) {
        const Vec<D> x = frame.centre(I) - middle;
        const real r = norm(x), h = 1.0 / 32;
        for (int a = 0; a < D; ++a)
            if (I[a] < 2 || I[a] > 29) return;
        if (r < 0.15 + 4.5 * h) return;  // the window reaches two cells along each axis
        EXPECT_NEAR(curvature_near(phi, frame, I) * r / (D - 1), 1, 2 * h * h / (r * r));
        slanted += std::abs(x[0]) > 0.5 * r && std::abs(x[1]) > 0.5 * r;
    });
    EXPECT_GT(slanted, 20);
}

// 6 periods of its slowest swing. Of a surface energy of 1.57 J/m a hundred thousandth moves; second differences of distances move a
// thousandth, and the drop by more than a cell.
TEST("a drop at rest off the grid's middle stays where it is") {
    set_threads(1);
    Water<2> water(test::water_scene(free_liquid("shape = \"sphere\", centre = [0.507, 0.507], radius = 0.25", 32, "")));
    const real front = test::integral(water, "front_x");
    while (water.time() < 2) water.step(water.advised_dt());
    EXPECT_LT(test::integral(water, "kinetic_energy"), 1e-5 * 1.57);
    EXPECT_NEAR(test::integral(water, "front_x"), front, 0.15 / 32);
}

// ω² = 6 σ/(ρ R³). 3% was asked for; of second order in k h, 12 cells a radian, with an amplitude of 4%: half a percent. What
// moves at its fastest in the second swing is at most two hundredths more than in the first; with FLIP alone, which damps nothing, six (5
// are measured; cases/water_drop asks for two).
TEST("a short capsule swings with the frequency of Rayleigh, and no faster from swing to swing") {
    set_threads(1);
    constexpr real area = pi * 0.04 + 0.4 * 0.04, radius = 0.2123;  // π R² = area
    const real period = 2 * pi / std::sqrt(6 / (radius * radius * radius));
    EXPECT_NEAR(pi * radius * radius, area, 1e-4);
    for (const char* scheme :
         {"transfer = \"flip\"", "transfer = \"flip\", flip_blend = 1.0", "transfer = \"apic\"", "transfer = \"grid\""}) {
        Water<2> water(
            test::water_scene(free_liquid("shape = \"capsule\", from = [0.48, 0.5], to = [0.52, 0.5], radius = 0.2", 48, scheme)));
        real before = stretch(water), t = 0, fastest = 0, later = 0, first = 0, last = 0;
        int crossings = 0;
        while (water.time() < 2 * period) {
            water.step(water.advised_dt());
            const real now = stretch(water), moves = test::integral(water, "kinetic_energy");
            if (before * now < 0) {
                last = t + (water.time() - t) * before / (before - now);
                if (crossings++ == 0) first = last;
            }
            before = now, t = water.time();
            (t < 0.5 * period ? fastest : later) = std::max(t < 0.5 * period ? fastest : later, moves);
        }
        ASSERT_EQ(crossings, 4) << scheme;
        EXPECT_NEAR(1.5 * period / (last - first), 1, 0.015) << scheme;
        EXPECT_LT(later, (std::string(scheme).ends_with("1.0") ? 1.06 : 1.02) * fastest) << scheme;
    }
}

}  // namespace weir::water::drops_tests
