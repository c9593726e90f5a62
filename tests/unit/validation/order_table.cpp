// Orders, Richardson's value and the GCI on sequences whose answers are known.
#include "validation/harness/order_table.hpp"

#include "support/test.hpp"

namespace order_table_tests {

using namespace weir;
using namespace weir::validation;

TEST("an error that is C h^p has order p between every pair, in whatever sequence it is added") {
    for (real p : {1.0, 1.8, 2.0, 3.0}) {
        OrderTable table(Quantity::error);
        for (real n : {64.0, 16.0, 32.0}) table.add(1 / n, 7 * std::pow(1 / n, p));
        ASSERT_EQ(table.rows().size(), 3u);
        EXPECT_EQ(table.rows().front().h, 1.0 / 16);
        EXPECT_TRUE(std::isnan(table.rows().front().order));
        for (std::size_t i : {1u, 2u}) EXPECT_NEAR(table.rows()[i].order, p, 1e-12);  // round-off of two logarithms
        EXPECT_NEAR(table.order(), p, 1e-12);
        EXPECT_NEAR(table.extrapolate().limit, 0, 1e-12);
    }
}

TEST("values f0 + C h^p give back p and f0 on equal and on unequal ratios") {
    for (const auto& grids : {std::vector<real>{10, 20, 40}, std::vector<real>{10, 15, 30}, std::vector<real>{12, 20, 26}}) {
        OrderTable table(Quantity::value);
        for (real n : grids) table.add(1 / n, 4.5 - 3 * std::pow(1 / n, 1.7));
        const Extrapolation x = table.extrapolate();
        EXPECT_NEAR(x.order, 1.7, 1e-8);  // the fixed point is iterated to convergence; cancellation in f2 - f1 costs digits
        EXPECT_NEAR(x.limit, 4.5, 1e-8);
        EXPECT_TRUE(x.monotone);
    }
}

// Celik et al. 2008, table 1. The bound is one unit of the last printed digit, because the paper cuts where it should round:
// its 1.53 is 1.537 when eq. 3 is iterated to the end.
TEST("the worked examples of Celik 2008 come out to the printed digits") {
    struct Example {
        real f1, f2, f3, r21, r32, p, limit, change, gci;
    };
    const Example examples[] = {
        {6.063, 5.972, 5.863, 1.5, 1.333, 1.53, 6.1685, 0.015, 0.022},
        {10.7880, 10.7250, 10.6050, 2.0, 2.143, 0.75, 10.8801, 0.006, 0.011},
        {6.0042, 5.9624, 6.0909, 2.0, 2.143, 1.51, 6.0269, 0.007, 0.005},
    };
    for (const auto& e : examples) {
        OrderTable table(Quantity::value);
        table.add(1, e.f1), table.add(e.r21, e.f2), table.add(e.r21 * e.r32, e.f3);
        const Extrapolation x = table.extrapolate();
        EXPECT_NEAR(x.order, e.p, 0.01);
        EXPECT_NEAR(x.limit, e.limit, 0.001);  // d(limit)/dp = 0.07, and p is known to 0.01
        EXPECT_NEAR(x.change, e.change, 0.001);
        EXPECT_NEAR(x.gci_fine, e.gci, 0.001);
    }
}

TEST("on grids of unequal ratios the index of each pair is of its own ratio: f0 + C h^p has an asymptotic ratio of f1/f2") {
    for (const auto& grids : {std::vector<real>{10, 15, 30}, std::vector<real>{12, 20, 26}}) {
        OrderTable table(Quantity::value);
        std::vector<real> f;
        for (real n : grids) f.push_back(4.5 - 3 * std::pow(1 / n, 1.7)), table.add(1 / n, f.back());
        const Extrapolation x = table.extrapolate();
        // GCI23 = F |f2 - f3| / f2 / (r32^p - 1) = F C h2^p / f2, GCI12 = F C h1^p / f1
        EXPECT_NEAR(x.gci_coarse, 1.25 * 3 * std::pow(1 / grids[1], 1.7) / f[1], 1e-8);
        EXPECT_NEAR(x.gci_fine, 1.25 * 3 * std::pow(1 / grids[2], 1.7) / f[2], 1e-8);
        EXPECT_NEAR(x.asymptotic, f[2] / f[1], 1e-7);
    }
}

TEST("the asymptotic ratio is 1 for a clean sequence and the third Celik example is seen to oscillate") {
    OrderTable clean(Quantity::value);
    for (real n : {64.0, 128.0, 256.0}) clean.add(1 / n, 1 + std::pow(1 / n, 2));
    EXPECT_NEAR(clean.extrapolate().asymptotic, 1, 1e-3);  // f1/f2 differs from 1 by 3 h^2 = 2e-4
    OrderTable swinging(Quantity::value);
    swinging.add(1, 6.0042), swinging.add(2, 5.9624), swinging.add(4.286, 6.0909);
    EXPECT_FALSE(swinging.extrapolate().monotone);
}

TEST("two grids and a formal order use the factor 3") {
    OrderTable table(Quantity::value);
    table.add(1, 1.0), table.add(2, 1.1);
    const Extrapolation x = table.extrapolate(2);
    EXPECT_NEAR(x.gci_fine, 3 * 0.1 / 3, 1e-12);            // F |f1 - f2| / |f1| / (2^2 - 1)
    EXPECT_TRUE(std::isnan(table.extrapolate().gci_fine));  // no order, no index
}

TEST("what cannot be said is NaN: one grid, equal values, a zero or NaN error") {
    OrderTable one(Quantity::error);
    one.add(1, 0.1);
    EXPECT_TRUE(std::isnan(one.order()));
    OrderTable flat(Quantity::value);
    for (real h : {1.0, 2.0, 4.0}) flat.add(h, 3);
    EXPECT_TRUE(std::isnan(flat.order()));
    OrderTable broken(Quantity::error);
    broken.add(2, std::nan("")), broken.add(1, 0.1);
    EXPECT_TRUE(std::isnan(broken.order()));
}

}  // namespace order_table_tests
