// Curvature of circles and spheres by heights, by fits, and by the mean of neighbours.
#include "support.hpp"
#include "two_phase/fit.hpp"

namespace curvature_tests {

using namespace weir;
using namespace weir::test;
using namespace weir::two_phase;

namespace {

template <int D>
struct Errors {
    real largest = 0, rms = 0;
    int count = 0;
};

/// Relative errors over all mixed cells where `kappa` is known.
template <int D, class F>
Errors<D> errors(int n, F&& kappa) {
    TwoPhase<D> solver(two_phase_scene(drop<D>(n), {{"liquid[0].centre", list({"0.507", "0.493", "0.511"}, D)}}));
    const auto& state = solver.state();
    Padded<D> padded(state.extent());
    FractionGhosts<D>(state.sides, -1, {}).fill_all(padded, solver.fraction());
    const Around<D> around(state.sides, state.u.cells);
    const Interface<D> interface { solver.fraction(), padded, around, state.u.h };
    const real exact = (D - 1) / 0.2;
    Errors<D> e;
    for_each_cell(replicated(state.extent()), [&](const Index<D>& I) {
        if (!is_mixed(solver.fraction()(I))) return;
        const real found = kappa(interface, I);
        if (found == no_curvature) return;
        const real error = std::abs(found / exact - 1);
        e.largest = std::max(e.largest, error), e.rms += error * error, ++e.count;
    });
    e.rms = std::sqrt(e.rms / std::max(e.count, 1));
    return e;
}

}  // namespace

// Second order: (h/R)² at 32 cells is 2.4%; the largest error of heights near the diagonal is a few times that (Popinet 2009, figure 5).
TEST_IN_2D_AND_3D("curvature by heights converges at second order") {
    set_threads(1);
    const auto by_heights = [](const Interface<D>& s, const Index<D>& I) { return curvature_by_heights(s, I); };
    const int n = D == 2 ? 32 : 24;
    const auto coarse = errors<D>(n, by_heights), fine = errors<D>(2 * n, by_heights);
    EXPECT_GT(coarse.count, n);
    EXPECT_LT(coarse.rms, D == 2 ? 0.02 : 0.04);
    EXPECT_LT(fine.rms, coarse.rms / 3);  // order 1.6 at least: 2 less the share of cells near the diagonal, which changes
}

// The middles of planes lie off the sphere by O(h²/R): the error does not vanish with h, and stays below a tenth (Popinet 2009).
TEST_IN_2D_AND_3D("curvature by fits is within a few per cent") {
    set_threads(1);
    const auto e = errors<D>(D == 2 ? 32 : 24, [](const Interface<D>& s, const Index<D>& I) { return curvature_by_fit(s, I); });
    EXPECT_GT(e.count, 20);
    EXPECT_LT(e.rms, 0.1);
}

TEST_IN_2D_AND_3D("the middle of a cut is on the plane, in the cell, and where symmetry puts it") {
    const real third = 1.0 / D;
    Vec<D> x;
    ASSERT_TRUE(middle_of_cut(Plane<D>{Vec<D>::constant(third), 0.5}, x));  // the hexagon through the middle; in 2D the diagonal
    for (int d = 0; d < D; ++d) EXPECT_NEAR(x[d], 0.5, 1e-15);
    ASSERT_TRUE(middle_of_cut(Plane<D>{Vec<D>::constant(third), 0.5 * third}, x));  // a triangle with corners at 1/2 on the axes
    for (int d = 0; d < D; ++d) EXPECT_NEAR(x[d], 0.5 / D, 1e-15);
    ASSERT_TRUE(middle_of_cut(Plane<D>{Vec<D>::unit(1), 0.3}, x));
    EXPECT_NEAR(x[0], 0.5, 1e-15);
    EXPECT_NEAR(x[1], 0.3, 1e-15);
    EXPECT_FALSE(middle_of_cut(Plane<D>{Vec<D>::unit(1), 1.3}, x));
}

}  // namespace curvature_tests
