// The arithmetic in single precision that lanes and devices share (kernels/single.inl), by itself.
#include "support/test.hpp"

#include <bit>
#include <cmath>

namespace {

#define WEIR_FN static inline
#define REAL float
#define SCALAR float
#define BITS(x) std::bit_cast<int>(x)
#define FROM_BITS(i) std::bit_cast<float>(i)
#define FNMA(a, b, c) std::fma(-(a), (b), (c))
#include "particles/kernels/single.inl"

namespace single_tests {}  // namespace single_tests

TEST("one over a square root is right to 1.5e-6, for every mantissa, and from 1e-36 to 1e36") {
    const auto error = [](float x) { return std::abs(static_cast<double>(inverse_root(x)) * std::sqrt(static_cast<double>(x)) - 1); };
    double worst = 0;
    for (int mantissa = 0; mantissa < 1 << 24; mantissa += 1)  // exponents even and odd
        worst = std::max(worst, error(FROM_BITS(0x3f800000 + mantissa)));
    // two Newton steps from the halved bits leave 1.28e-6 at best (its extremes are all equally large), three roundings 6e-8 each
    EXPECT_LE(worst, 1.5e-6);
    EXPECT_GE(worst, 1.2e-6);
    for (const float x : {1e-36f, 1e-20f, 1e-6f, 1e6f, 1e12f, 1e36f}) EXPECT_LE(error(x), 1.5e-6) << x;
}

}  // namespace
