// The signed distance for drawing and probes.
#include "support.hpp"

#include "free_surface/level_set.hpp"

#include <cmath>
namespace distance_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

template <int D>
Grid<real, D> distance_of(const TwoPhase<D>& solver) {
    for (const auto& field : solver.fields().fields)
        if (field.name == level_set_name) {
            Grid<real, D> phi(solver.state().extent());
            std::copy(field.data[0].begin(), field.data[0].end(), phi.values().begin());
            return phi;
        }
    ADD_FAILURE() << "no level set";
    return {};
}

/// Largest difference to f(middle of the cell), cut off at two cells, relative to a cell, over the cells in which f is not infinite.
template <int D, class F>
real error_of(const TwoPhase<D>& solver, F&& f) {
    const Grid<real, D> phi = distance_of(solver);
    const Vec<D> h = solver.state().u.h;
    real most = 0;
    for_each_cell(phi.extent(), [&](const Index<D>& I) {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = (I[d] + 0.5) * h[d];
        if (const real exact = f(x); exact < infinity)
            most = std::max(most, std::abs(phi(I) - std::clamp(exact, -2 * h[0], 2 * h[0])) / h[0]);
    });
    return most;
}

/// Planes in cells of width h depart from a sphere of radius R by h²/(8R) in their middle, and by as much more where their normal is wrong
/// by its own second-order error; so errors are of order h²/R = h · (h/R).
template <int D>
void drop_is_second_order(int n) {
    const auto error = [](int cells) {
        TwoPhase<D> solver(two_phase_scene(drop<D>(cells)));
        return error_of(solver, [](const Vec<D>& x) { return norm(x - Vec<D>::constant(0.5)) - 0.2; });
    };
    const real coarse = error(n), fine = error(2 * n);
    EXPECT_LT(coarse, 1 / (0.2 * n)) << D;
    EXPECT_LT(fine, 0.7 * coarse) << D;  // relative to a cell, of first order: half
}

/// The front of a column that begins outside the domain, where the top is more than two cells away; or that begins in its corner.
template <int D>
real error_of_front(const std::string& begin, real h) {
    TwoPhase<D> solver(two_phase_scene(collapse<D>(), {{"liquid", "[ { shape = \"box\", min = " + list({begin, begin, begin}, D) +
                                                                      ", max = " + list({"0.41", "0.63", "1.0"}, D) + " } ]"}}));
    return error_of(solver, [&](const Vec<D>& x) { return x[1] > 0.63 - 3 * h ? infinity : x[0] - 0.41; });
}

}  // namespace

TEST("the level set is the distance to the interface: exact for a flat front, second order for a drop, cut off at two cells") {
    EXPECT_LT(error_of_front<2>("-1.0", 1.0 / 16), 1e-11);
    EXPECT_LT(error_of_front<3>("-1.0", 1.0 / 16), 1e-11);
    drop_is_second_order<2>(24), drop_is_second_order<3>(24);
}

TEST("a column that begins in the corner of the tank has no gas there") {
    // The foot of the front, an edge of the box, is cut by one plane in sub-cells of h/16 (h/8 in 3D): less than h/100.
    EXPECT_LT(error_of_front<2>("0.0", 1.0 / 16), 0.01);
    EXPECT_LT(error_of_front<3>("0.0", 1.0 / 16), 0.01);
}

TEST("the level set is cut off deep in both fluids, where fractions depart from 1 and 0 by round-off") {
    TwoPhase<2> solver(two_phase_scene(collapse<2>(), {{"scheme.poisson.tolerance", "1e-6"}}));
    run(solver, 10);
    const auto phi = distance_of(solver);
    const real h = 1.0 / 16;
    for (int j = 0; j < 6; ++j)
        for (const int i : {0, 1, 2, 12, 13, 14, 15}) EXPECT_EQ(phi({i, j}), i < 3 ? -2 * h : 2 * h) << i << " " << j;
}

TEST("the level set does not depend on the number of threads") {
    const auto values = [](int threads) {
        set_threads(threads);
        const TwoPhase<3> solver(two_phase_scene(drop<3>(24)));
        const auto phi = distance_of(solver);
        return std::vector<real>(phi.values().begin(), phi.values().end());
    };
    EXPECT_EQ(values(3), values(1));
}

}  // namespace distance_tests
