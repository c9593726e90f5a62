// Exact sums: the correctly rounded sum, for any order and any distribution of the terms.
#include "core/exact_sum.hpp"

#include "support/test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace weir::exact_sum_tests {
namespace {

real sum_of(const std::vector<real>& terms) {
    ExactSum sum;
    for (const real term : terms) sum.add(term);
    ExactSum together;
    together.add(std::span<const real>(terms));
    const real a = sum.value(), b = together.value();
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " one by one, " << b << " together";
    return a;
}

TEST("an exact sum keeps what a floating-point sum loses") {
    EXPECT_EQ(sum_of({}), 0);
    EXPECT_EQ(sum_of({1e300, 1, -1e300}), 1);                                  // 600 decades apart
    EXPECT_EQ(sum_of({1e308, 1e308, -1e308}), 1e308);                          // beyond the range in between
    EXPECT_EQ(sum_of({1e-320, -5e-324}), 1e-320 - 5e-324);                     // subnormal
    EXPECT_EQ(sum_of(std::vector<real>(100000, 0.1)), 10000.000000000000555);  // 1e5 times the double nearest to 0.1
}

TEST("an exact sum is rounded once: to nearest, ties to even") {
    const real half = 0x1p-53, little = 0x1p-200;  // half a unit in the last place of 1
    EXPECT_EQ(sum_of({1, half}), 1);
    EXPECT_EQ(sum_of({1, half, little}), 1 + 0x1p-52);
    EXPECT_EQ(sum_of({1 + 0x1p-52, half}), 1 + 0x1p-51);
    EXPECT_EQ(sum_of({-1, -half}), -1);
    EXPECT_EQ(sum_of({-1, -half, -little}), -1 - 0x1p-52);
    EXPECT_EQ(sum_of({1, half, -little}), 1);
}

TEST("an exact sum does not depend on order or distribution") {
    std::mt19937_64 random(1);
    std::normal_distribution<real> normal;
    std::vector<real> terms(20000);
    for (real& term : terms) term = normal(random) * std::exp(20 * normal(random));
    const real sum = sum_of(terms);
    for (int trial = 0; trial < 5; ++trial) {
        std::shuffle(terms.begin(), terms.end(), random);
        EXPECT_EQ(sum_of(terms), sum);
        std::array<ExactSum, 3> parts;
        for (std::size_t i = 0; i < terms.size(); ++i) parts[i * i % 3].add(terms[i]);
        ExactSum all;
        for (const auto& part : parts) all.add(part);
        EXPECT_EQ(all.value(), sum);
    }
    ExactSum together;
    together.add(std::span<const real>(terms));
    EXPECT_EQ(together.value(), sum);
    terms.push_back(-sum);  // what is left is at most half a unit in the last place of the sum
    EXPECT_LE(std::abs(sum_of(terms)), 0.5 * std::numeric_limits<real>::epsilon() * std::abs(sum));
}

TEST("an exact sum passes on infinities and NaN") {
    EXPECT_EQ(sum_of({1, infinity, -5}), infinity);
    EXPECT_EQ(sum_of({-infinity, 1e308, 1e308}), -infinity);
    EXPECT_TRUE(std::isnan(sum_of({infinity, -infinity})));
    EXPECT_TRUE(std::isnan(sum_of({1, std::numeric_limits<real>::quiet_NaN()})));
    EXPECT_EQ(sum_of({1e308, 1e308}), infinity);  // overflow of the result
}

TEST("exact sums of a struct are those of its components") {
    struct Pair {
        real a, b;
    };
    ExactSums<Pair> sums, more;
    sums.add({1e300, 2});
    more.add({1, 0x1p-60});
    more.add({-1e300, -2});
    sums.add(more);
    EXPECT_EQ(sums.value().a, 1);
    EXPECT_EQ(sums.value().b, 0x1p-60);
}

}  // namespace
}  // namespace weir::exact_sum_tests
