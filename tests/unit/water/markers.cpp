#include "free_surface/markers.hpp"
#include "free_surface/marker_motion.hpp"
#include "support.hpp"

#include <algorithm>

namespace markers_tests {

using namespace weir;
using namespace weir::water;

namespace {

template <int D>
Frame<D> unit_frame(int n) {
    return Frame<D>(MacVelocity<D>(replicated(Index<D>::constant(n)), Vec<D>::constant(1.0 / n), Vec<D>{}), geometry::Sides<D>());
}

template <int D>
Markers<D> random_markers(std::size_t count, bool velocity) {
    Markers<D> markers(velocity, false);
    for (std::size_t p = 0; p < count; ++p) {
        Vec<D> x, v;
        for (int d = 0; d < D; ++d) {
            x[d] = hashed_random(3, p, static_cast<std::uint64_t>(d));
            v[d] = x[d] * x[d];
        }
        markers.add(x, v);
    }
    return markers;
}

}  // namespace

TEST_IN_2D_AND_3D("sorting puts every marker into the run of its cell, keeps what it carries, and keeps the order inside a cell") {
    const auto frame = unit_frame<D>(7);
    auto markers = random_markers<D>(2000, true);
    markers.sort(frame);
    std::size_t seen = 0;
    for (std::size_t cell = 0; cell < product(frame.cells); ++cell)
        for (std::size_t p = markers.begin(cell); p < markers.end(cell); ++p, ++seen) {
            EXPECT_EQ(frame.cell_of(markers.position(p)), frame.index_of(cell));
            for (std::size_t d = 0; d < D; ++d) EXPECT_EQ(markers.v[d][p], markers.x[d][p] * markers.x[d][p]);
        }
    EXPECT_EQ(seen, 2000u);
    const auto once = markers.x;
    markers.sort(frame);
    EXPECT_EQ(markers.x, once) << "stable";
}

TEST_IN_2D_AND_3D("jittered places lie in their half cells, differ between seeds, and mirror each other about the middle of the domain") {
    for (const int n : {6, 7}) {
        const auto frame = unit_frame<D>(n);
        const real h = 1.0 / n;
        for_each_cell(frame.cells, [&](const Index<D>& I) {
            for (int sub = 0; sub < Markers<D>::per_cell; ++sub) {
                const Vec<D> x = Markers<D>::jittered(frame, I, sub, 5);
                Index<D> mirror = I;
                mirror[0] = n - 1 - I[0];
                const Vec<D> y = Markers<D>::jittered(frame, mirror, sub ^ 1, 5);
                EXPECT_NEAR(x[0] + y[0], 1, 1e-15);
                for (int d = 1; d < D; ++d) EXPECT_EQ(x[d], y[d]);
                for (int d = 0; d < D; ++d) {
                    EXPECT_GE(x[d], h * (I[d] + 0.5 * (sub >> d & 1)) - 1e-15);
                    EXPECT_LE(x[d], h * (I[d] + 0.5 * (sub >> d & 1) + 0.5) + 1e-15);
                }
                EXPECT_NE(x[0], Markers<D>::jittered(frame, I, sub, 6)[0]);
            }
        });
    }
}

TEST("markers in solid rotation come back at the order of the scheme: 2 for RK2, 3 for RK3") {
    // u = (−y, x) is linear, so interpolation is exact and only the error in time remains.
    MacVelocity<2> u(replicated(Index<2>{{16, 16}}), Vec<2>::constant(1.0 / 8), Vec<2>::constant(-1));
    for (int a = 0; a < 2; ++a)
        for_each_cell(u[a].extent(), [&](const Index<2>& I) {
            const Vec<2> x = u.face_centre(a, I);
            u[a](I) = a == 0 ? -x[1] : x[0];
        });
    const Frame<2> frame(u, geometry::Sides<2>());
    const auto error = [&](Trace order, int steps) {
        Vec<2> x{{0.5, 0.1}};
        for (int i = 0; i < steps; ++i) x = trace(u, frame, x, 1.0 / steps, order);
        const Vec<2> exact{{0.5 * std::cos(1.0) - 0.1 * std::sin(1.0), 0.5 * std::sin(1.0) + 0.1 * std::cos(1.0)}};
        return norm(x - exact);
    };
    EXPECT_NEAR(std::log2(error(Trace::rk1, 40) / error(Trace::rk1, 80)), 1, 0.1);
    EXPECT_NEAR(std::log2(error(Trace::rk2, 40) / error(Trace::rk2, 80)), 2, 0.1);
    EXPECT_NEAR(std::log2(error(Trace::rk3, 40) / error(Trace::rk3, 80)), 3, 0.1);
}

TEST_IN_2D_AND_3D("no marker leaves through a wall, and those that leave through an open side are removed and counted") {
    auto markers = random_markers<D>(500, false);
    MacVelocity<D> u(replicated(Index<D>::constant(8)), Vec<D>::constant(1.0 / 8), Vec<D>{});
    u[0].fill(3);
    geometry::Sides<D> sides;
    const Frame<D> frame(u, sides);
    markers.sort(frame);
    move_markers(markers, u, frame, 1.0, Trace::rk2, sides, geometry::Solids<D>(), Grid<std::uint8_t, D>());
    EXPECT_EQ(remove_departed(markers, frame, sides), 0u);
    EXPECT_LT(*std::max_element(markers.x[0].begin(), markers.x[0].end()), 1.0);
    sides.side(0, 1).kind = geometry::SideKind::outflow;
    markers.sort(frame);
    move_markers(markers, u, frame, 1.0, Trace::rk2, sides, geometry::Solids<D>(), Grid<std::uint8_t, D>());
    EXPECT_EQ(remove_departed(markers, frame, sides), 500u);
    EXPECT_EQ(markers.count(), 0u);
}

}  // namespace markers_tests
