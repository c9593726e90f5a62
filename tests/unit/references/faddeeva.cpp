// w(z) against what is known of it: erfcx on the imaginary axis, Dawson's integral on the real one, its differential equation between.
#include "validation/references/faddeeva.hpp"

#include "support/test.hpp"

#include <gsl/gsl_sf_dawson.h>
#include <gsl/gsl_sf_erf.h>

namespace faddeeva_tests {

using namespace weir;
using namespace weir::validation;

// 1e-12: Weideman's expansion with 40 terms has fallen to the round-off of sums of 160 terms.
TEST("on the imaginary axis it is exp(x^2) erfc(x)") {
    for (real x = 0; x < 25; x += 0.37) {
        const real erfcx = std::exp(x * x + gsl_sf_log_erfc(x));
        EXPECT_NEAR(faddeeva({0, x}).real() / erfcx, 1, 1e-12 + 1e-15 * x * x) << x;  // exp and log cost x^2 units of round-off
        EXPECT_NEAR(faddeeva({0, x}).imag(), 0, 1e-13);
    }
}

TEST("on the real axis it is exp(-x^2) + 2i/sqrt(pi) Dawson(x)") {
    for (real x = -12; x < 12; x += 0.41) {
        const Complex w = faddeeva({x, 0});
        EXPECT_NEAR(w.real(), std::exp(-x * x), 1e-13);
        EXPECT_NEAR(w.imag(), 2 / std::sqrt(pi) * gsl_sf_dawson(x), 1e-13);
    }
}

TEST("dw/dz = -2 z w + 2i/sqrt(pi) in both half planes") {
    const real h = 1e-3;  // sixth-order difference: h^6 below 1e-17, round-off 1e-13 / h
    for (real x = -3; x <= 3; x += 0.53)
        for (real y = -1.5; y <= 3; y += 0.31) {
            const Complex z(x, y);
            const auto d = [&](real s) { return faddeeva(z + s * h) - faddeeva(z - s * h); };
            const Complex slope = (45.0 * d(1) - 9.0 * d(2) + d(3)) / (60 * h);
            const Complex expected = -2.0 * z * faddeeva(z) + Complex(0, 2 / std::sqrt(pi));
            EXPECT_NEAR(std::abs(slope - expected), 0, 1e-9 * (1 + std::abs(expected))) << z;
        }
}

TEST("mirror z -> -conj(z) conjugates it, and far away it is i/(sqrt(pi) z)") {
    for (real x : {0.3, 1.7, 4.2})
        for (real y : {-1.0, 0.2, 3.0}) EXPECT_NEAR(std::abs(faddeeva({-x, y}) - std::conj(faddeeva({x, y}))), 0, 1e-12);
    const Complex z(300, 200);
    EXPECT_NEAR(std::abs(faddeeva(z) * z * std::sqrt(pi) / Complex(0, 1) - 1.0), 0, 1 / std::norm(z));  // next term 1/(2 z^2)
}

}  // namespace faddeeva_tests
