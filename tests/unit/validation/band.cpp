// The band of three grids on sequences whose limit is known.
#include "validation/harness/band.hpp"

#include "core/error.hpp"
#include "support/test.hpp"

namespace band_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// f0 + C h^p on grids of n cells.
std::vector<GridValue> power(real f0, real C, real p, const std::vector<real>& cells) {
    std::vector<GridValue> grids;
    for (const real n : cells) grids.push_back({1 / n, {f0 + C * std::pow(1 / n, p)}});
    return grids;
}

}  // namespace

TEST("the observed order of C h^p is p, on any three grids") {
    for (const real p : {-1.0, 0.0, 0.3, 1.0, 2.0, 4.0}) {
        const auto f = [&](real h) { return p == 0 ? std::log(h) : std::pow(h, p); };  // log h is the limit of (h^p - 1)/p
        for (const auto& [h1, h2, h3] : {std::array<real, 3>{1, 2, 4}, {1, 1.3, 2.1}, {0.01, 0.015, 0.017}})
            EXPECT_NEAR(observed_order(std::abs(f(h1) - f(h2)), std::abs(f(h2) - f(h3)), h1, h2, h3), p, 1e-9);
    }
    EXPECT_EQ(observed_order(1e-30, 1, 1, 2, 4), 12);
    EXPECT_EQ(observed_order(1, 1e-30, 1, 2, 4), -4);
}

TEST("an asymptotic sequence has a band of 1.5 times its error") {
    for (const real p : {0.7, 1.0, 1.6, 2.0}) {
        const Band b = band(power(3, 0.5, p, {20, 30, 45}), 2);
        EXPECT_EQ(b.convergence, Convergence::asymptotic);
        EXPECT_NEAR(b.observed_order, p, 1e-8);
        EXPECT_NEAR(b.width, 1.5 * 0.5 * std::pow(1.0 / 45, p), 1e-9);
    }
}

TEST("an order above the formal one is not believed") {
    const real h1 = 1.0 / 40, h2 = 1.0 / 20, h3 = 1.0 / 10;
    const Band b = band(power(3, 0.5, 5, {10, 20, 40}), 1);
    EXPECT_EQ(b.convergence, Convergence::faster);
    EXPECT_EQ(b.order, 1);
    const real coarse = 0.5 * (std::pow(h3, 5) - std::pow(h2, 5));  // the larger of the two differences counts
    EXPECT_NEAR(b.width, 2 * coarse / (h3 - h2) * h1, 1e-15);
}

TEST("one difference that is small by accident does not shrink the band") {
    const std::vector<GridValue> grids{{0.04, {1.4}}, {0.02, {1.2}}, {0.01, {1.2000001}}};
    const Band b = band(grids, 2);
    EXPECT_EQ(b.convergence, Convergence::oscillating);
    EXPECT_NEAR(b.width, 2 * 0.2 / 0.02 * 0.01, 1e-12);
}

TEST("differences that do not shrink, oscillate or vanish are told") {
    EXPECT_EQ(band({{0.04, {1}}, {0.02, {2}}, {0.01, {3}}}, 2).convergence, Convergence::slow);
    EXPECT_EQ(band({{0.04, {1}}, {0.02, {2}}, {0.01, {1.8}}}, 2).convergence, Convergence::oscillating);
    const Band b = band({{0.04, {1}}, {0.02, {1}}, {0.01, {1}}}, 2);
    EXPECT_EQ(b.convergence, Convergence::equal);
    EXPECT_EQ(b.width, 0);
}

TEST("a curve is measured by its root mean square, and oscillates where its differences are opposed") {
    const auto grid = [](real h, real sign) { return GridValue{h, {1 + sign * 3 * h, 1 - sign * 4 * h}}; };
    const Band b = band({grid(0.04, 1), grid(0.02, 1), grid(0.01, 1)}, 1);
    EXPECT_EQ(b.convergence, Convergence::asymptotic);
    EXPECT_NEAR(b.width, 1.5 * 0.01 * std::sqrt(12.5), 1e-12);
    EXPECT_EQ(band({grid(0.04, -1), grid(0.02, 1), grid(0.01, 1)}, 1).convergence, Convergence::oscillating);
    EXPECT_THROW(band({grid(0.02, 1), grid(0.01, 1)}, 1), BadInput);
}

TEST("of more grids the finest three count") {
    auto grids = power(3, 0.5, 1, {20, 30, 45});
    const real three = band(grids, 1).width;
    grids.insert(grids.begin(), {0.1, {100}});
    EXPECT_EQ(band(grids, 1).width, three);
}

}  // namespace band_tests
