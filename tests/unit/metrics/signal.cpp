// Signals whose numbers are known.
#include "validation/metrics/signal.hpp"

#include "support/test.hpp"

#include <functional>

namespace signal_tests {

using namespace weir;
using namespace weir::validation;

namespace {

Curve sampled(const std::function<real(real)>& f, real end, int n) {
    Curve c;
    for (int i = 0; i <= n; ++i) c.x.push_back(end * i / n), c.y.push_back(f(c.x.back()));
    return c;
}

}  // namespace

TEST("a damped cosine gives back frequency and decay") {
    const real w = 3, gamma = 0.2;
    const Curve c = sampled([&](real t) { return std::exp(-gamma * t) * std::cos(w * t); }, 10, 2000);
    EXPECT_NEAR(frequency(c), w, 1e-5 * w);  // straight lines between samples 0.005 apart: (w dt)^2 / 8 of a step
    EXPECT_NEAR(decay(c), gamma, 1e-3 * gamma);
    EXPECT_EQ(zero_crossings(c).size(), 10u);  // at (n + 1/2) pi / 3 < 10
}

TEST("the tops of a swing lie between its samples, on the parabola through three of them") {
    const Curve tops = extrema(sampled([](real t) { return std::cos(3 * t); }, 10, 100));
    ASSERT_GE(tops.size(), 8u);
    // What the parabola leaves of cos is (w dt)^4/24 at most, 3.4e-4; the largest of the samples is up to (w dt)^2/8 below the top, 1e-2.
    for (const real y : tops.y) EXPECT_NEAR(y, 1, 3.4e-4);
}

TEST("what has no oscillation has no frequency and no decay") {
    const Curve c = sampled([](real t) { return 1 + t; }, 1, 10);
    EXPECT_TRUE(std::isnan(frequency(c)));
    EXPECT_TRUE(std::isnan(decay(c)));
}

TEST("a power law gives back its exponent, in the window only") {
    const Curve c = sampled([](real t) { return t < 1 ? 7 : 5 * std::pow(t, 2.0 / 3); }, 10, 500);
    EXPECT_NEAR(power_law(c, 1, 10), 2.0 / 3, 1e-12);
    EXPECT_NEAR(power_law(c, 0.1, 0.9), 0, 1e-12);
    EXPECT_TRUE(std::isnan(power_law(c, 20, 30)));
}

}  // namespace signal_tests
