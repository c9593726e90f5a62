// Multigrid on columns: the counts that the hierarchy promises, at any resolution and height.
#include "tallcell/multigrid.hpp"

#include "support.hpp"

namespace weir::test::multigrid_tests {
namespace {

template <int D>
int iterations(const Index<D>& cells, int longest, real waves) {
    Basin<D> basin(cells, cells[1] / 16, 0.8, waves);
    TallPressure<D> tall(basin.frame, 1, {.tolerance = 1e-8, .max_iterations = 100});
    if (longest > 0)
        tall.set_surface(basin.phi, basin.closed, basin.state, any_knots(basin, longest));
    else
        tall.set_surface(basin.phi, basin.closed, basin.state, [&](const auto& layout, const auto& state, Knots& knots) {
            const auto deep = [&](std::size_t cell) { return basin.phi[cell] < -4 * basin.frame.h[1]; };
            place_knots(layout, state, longest == 0 ? Division::stacked : Division::single, 8, deep, knots);
        });
    basin.stir();
    tall.restrict_velocity(basin.state);
    return tall.project(basin.phi, basin.state, 1).iterations;
}

TEST("multigrid on columns needs at most 12 iterations for eight digits, at any resolution and height, single and stacked") {
    for (const int longest : {0, -1}) {
        for (const Index<2>& cells : {Index<2>{32, 64}, Index<2>{64, 64}, Index<2>{64, 256}, Index<2>{256, 256}, Index<2>{128, 512}})
            for (const real waves : {0.02, 0.15})
                EXPECT_LE(iterations<2>(cells, longest, waves), 12) << longest << ' ' << cells[0] << " x " << cells[1] << ' ' << waves;
        for (const Index<3>& cells : {Index<3>{32, 64, 32}, Index<3>{33, 96, 20}})
            for (const real waves : {0.02, 0.15})
                EXPECT_LE(iterations<3>(cells, longest, waves), 12) << longest << ' ' << cells[0] << " x " << cells[1] << ' ' << waves;
    }
}

TEST_IN_2D_AND_3D("the preconditioner is symmetric and positive") {
    Index<D> cells;
    cells.fill(17);
    Basin<D> basin(cells, 3);
    TallPressure<D> tall(basin.frame, 1, {});
    tall.set_surface(basin.phi, basin.closed, basin.state, any_knots(basin, 6));
    std::vector<real> a(static_cast<std::size_t>(tall.knots().count())), b(a.size()), Ma(a.size()), Mb(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = basin.uniform(-1, 1), b[i] = basin.uniform(-1, 1);
    tall.solver().precondition(tall.matrix(), tall.knots(), a, Ma);
    tall.solver().precondition(tall.matrix(), tall.knots(), b, Mb);
    real aMb = 0, bMa = 0, aMa = 0;
    for (std::size_t i = 0; i < a.size(); ++i) aMb += a[i] * Mb[i], bMa += b[i] * Ma[i], aMa += a[i] * Ma[i];
    EXPECT_GT(aMa, 0);
    EXPECT_NEAR(aMb, bMa, 3e-6 * aMa);  // single precision, 2^-24, through some fifty operations one after another
}

TEST_IN_2D_AND_3D("around periodic axes with an odd number of columns a cycle knows nothing of the one before, to the last bit") {
    Index<D> cells;
    cells.fill(17);
    Basin<D> basin(cells, 3);
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1})
            if (a != 1) basin.state.sides.side(a, end).kind = geometry::SideKind::periodic;
    basin.frame = Frame<D>(basin.state.u, basin.state.sides);
    TallPressure<D> tall(basin.frame, 1, {});
    tall.set_surface(basin.phi, basin.closed, basin.state, any_knots(basin, 6));
    std::vector<real> a(static_cast<std::size_t>(tall.knots().count())), b(a.size()), first(a.size()), Mb(a.size()), again(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = basin.uniform(-1, 1), b[i] = basin.uniform(-1, 1);
    tall.solver().precondition(tall.matrix(), tall.knots(), a, first);
    tall.solver().precondition(tall.matrix(), tall.knots(), b, Mb);
    tall.solver().precondition(tall.matrix(), tall.knots(), a, again);
    EXPECT_EQ(first, again);
}

}  // namespace
}  // namespace weir::test::multigrid_tests
