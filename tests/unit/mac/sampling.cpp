#include "mac/advection/near_sample.hpp"
#include "mac/advection/sample.hpp"
#include "support/test.hpp"

#include "parallel/grid.hpp"

namespace weir::mac::sampling_tests {

namespace {

/// A field of one kind of node filled with f(node position in cells).
template <int D, class F>
Padded<D> filled(int node_axis, F f) {
    Extent<D> extent(Index<D>::constant(8));
    if (node_axis >= 0) ++extent[node_axis];
    Padded<D> q(extent);
    const Index<D> ghosts = Index<D>::constant(ghost_layers);
    for_each_in(Index<D>{} - ghosts, extent + ghosts, [&](const Index<D>& I) {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = I[d] + (d == node_axis ? 0.0 : 0.5);
        q(I) = f(x);
    });
    return q;
}

template <int D>
Displacement<D> displaced(int count, real reach, int seed) {
    Displacement<D> x;
    for (int d = 0; d < D; ++d)
        for (int i = 0; i < count; ++i) x.d[d][i] = reach * std::sin(12.9898 * (i + 1) + 78.233 * (d + seed));
    return x;
}

template <int D>
Vec<D> point(int home_axis, const Index<D>& first, int i, const Displacement<D>& x) {
    Vec<D> p;
    for (int d = 0; d < D; ++d) p[d] = first[d] + (d == 0 ? i : 0) + (d == home_axis ? 0.0 : 0.5) + x.d[d][i];
    return p;
}

}  // namespace

TEST_IN_2D_AND_3D("linear interpolation reproduces linear functions from any node kind, cubic ones cubics") {
    const auto line = [](const Vec<D>& x) { return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[D - 1]; };
    const auto cube = [](const Vec<D>& x) { return x[0] * x[0] * x[0] - 2 * x[1] * x[1] * x[0] + x[D - 1]; };
    const Index<D> first = Index<D>::constant(2);
    real out[4];
    for (int home = -1; home < D; ++home)
        for (int node = -1; node < D; ++node) {
            const auto x = displaced<D>(4, 1.4, home + 2);
            const auto flat = filled<D>(node, line), curved = filled<D>(node, cube);
            sample_linear(RowView<D>(flat, first, node, home), x, 4, out);
            for (int i = 0; i < 4; ++i) EXPECT_NEAR(out[i], line(point(home, first, i, x)), 1e-12);
            sample_cubic(RowView<D>(curved, first, node, home), x, 4, lagrange_cubic, out);
            for (int i = 0; i < 4; ++i) EXPECT_NEAR(out[i], cube(point(home, first, i, x)), 1e-11);
        }
}

TEST_IN_2D_AND_3D("the fast path for short displacements agrees with the general one, bounds included") {
    const auto wild = [](const Vec<D>& x) { return std::sin(5 * x[0] + 3 * x[1] * x[1]) + std::cos(7 * x[D - 1]); };
    const Index<D> first = Index<D>::constant(1);
    real general[6], fast[6], low[6], high[6], low_fast[6], high_fast[6];
    for (int home = -1; home < D; ++home)
        for (int node = -1; node < D; ++node) {
            const auto q = filled<D>(node, wild);
            const auto x = displaced<D>(6, home == node ? 1.0 : 0.5, node + 5);
            const RowView<D> view(q, first, node, home);
            sample_linear(view, x, 6, general);
            sample_near(view, x, 6, fast);
            for (int i = 0; i < 6; ++i) EXPECT_NEAR(fast[i], general[i], 1e-14);
            if (home != node) continue;
            sample_bounds(view, x, 6, low, high);
            sample_near_bounded(view, x, 6, fast, low_fast, high_fast);
            for (int i = 0; i < 6; ++i) {
                EXPECT_EQ(low[i], low_fast[i]);
                EXPECT_EQ(high[i], high_fast[i]);
                EXPECT_LE(low[i], fast[i] + 1e-15);
                EXPECT_GE(high[i], fast[i] - 1e-15);
            }
        }
}

TEST_IN_2D_AND_3D("whichever axes eight neighbours stand on one side of their homes along, or on them, the fast path agrees") {
    const auto wild = [](const Vec<D>& x) { return std::sin(5 * x[0] + 3 * x[1] * x[1]) + std::cos(7 * x[D - 1]); };
    constexpr int count = 8, cases = D == 2 ? 16 : 64;  // along each axis: both sides, above, below, on
    const Index<D> first = e<D>(1) + e<D>(D - 1);
    real general[count], fast[count], low[count], high[count], low_fast[count], high_fast[count];
    for (int home = -1; home < D; ++home)
        for (int node = -1; node < D; ++node)
            for (int sides = 0; sides < cases; ++sides) {
                const auto q = filled<D>(node, wild);
                auto x = displaced<D>(count, home == node ? 1.0 : 0.5, node + 5);
                for (int d = 0; d < D; ++d)
                    for (int i = 0; i < count; ++i) {
                        const int side = sides >> (2 * d) & 3;
                        real& at = x.d[d][i];
                        at = side == 0 ? at : side == 1 ? std::abs(at) : side == 2 ? -std::abs(at) : 0;
                    }
                const RowView<D> view(q, first, node, home);
                sample_linear(view, x, count, general);
                sample_near(view, x, count, fast);
                for (int i = 0; i < count; ++i) EXPECT_NEAR(fast[i], general[i], 1e-14);
                if (home != node) continue;
                sample_bounds(view, x, count, low, high);
                sample_near_bounded(view, x, count, fast, low_fast, high_fast);
                for (int i = 0; i < count; ++i) {
                    EXPECT_NEAR(fast[i], general[i], 1e-14);
                    EXPECT_EQ(low[i], low_fast[i]);
                    EXPECT_EQ(high[i], high_fast[i]);
                }
            }
}

TEST("the monotone cubic never leaves the range of its data; Lagrange's does") {
    const real data[] = {0, 0, 1, 1};
    real most = 0, least = 1, lagrange_least = 1;
    for (int i = 0; i <= 100; ++i) {
        const real f = i / 100.0;
        const real value = monotone_cubic(data[0], data[1], data[2], data[3], 1 - f, f);
        most = std::max(most, value);
        least = std::min(least, value);
        const real step = lagrange_cubic(0, 0, 0, 1, 1 - f, f);
        lagrange_least = std::min(lagrange_least, step);
    }
    EXPECT_LE(most, 1);
    EXPECT_GE(least, 0);
    EXPECT_LT(lagrange_least, -0.05);
}

TEST_IN_2D_AND_3D("mirrored points give the same bits from mirrored data") {
    const auto wild = [](const Vec<D>& x) { return std::sin(5 * x[0] + 3 * x[1] * x[1]) + std::cos(7 * x[D - 1]); };
    for (int node = -1; node < D; ++node) {
        const auto q = filled<D>(node, wild);
        auto mirrored = q;
        const Index<D> ghosts = Index<D>::constant(ghost_layers);
        const int last = q.extent()[0] - 1;
        for_each_in(Index<D>{} - ghosts, q.extent() + ghosts, [&](const Index<D>& I) {
            Index<D> J = I;
            J[0] = last - I[0];
            mirrored(J) = q(I);
        });
        for (int trial = 0; trial < 200; ++trial) {
            auto x = displaced<D>(1, 1.9, trial);
            auto y = x;
            y.d[0][0] = -x.d[0][0];
            Index<D> home = Index<D>::constant(3), image = home;
            image[0] = last - home[0];
            real left = 0, right = 0;
            sample_linear(RowView<D>(q, home, node, node), x, 1, &left);
            sample_linear(RowView<D>(mirrored, image, node, node), y, 1, &right);
            EXPECT_EQ(left, right);
            for (int d = 0; d < D; ++d) x.d[d][0] /= 2, y.d[d][0] /= 2;  // 0.95
            sample_near(RowView<D>(q, home, node, node), x, 1, &left);
            sample_near(RowView<D>(mirrored, image, node, node), y, 1, &right);
            EXPECT_EQ(left, right);
            sample_cubic(RowView<D>(q, home, node, node), x, 1, monotone_cubic, &left);
            sample_cubic(RowView<D>(mirrored, image, node, node), y, 1, monotone_cubic, &right);
            EXPECT_EQ(left, right);
        }
    }
}

}  // namespace weir::mac::sampling_tests
