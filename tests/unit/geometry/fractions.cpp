#include "geometry/solids.hpp"
#include "support/test.hpp"

#include <random>

namespace fractions_tests {

using namespace weir;
using namespace weir::geometry;

TEST("the open fraction of a face cut by a plane is exact") {
    // f(x, y) = a + b x + c y is linear on edges and in the square, so marching squares has no error; compared with 1-D quadrature.
    std::mt19937 random(3);
    std::uniform_real_distribution<real> uniform(-1, 1);
    for (int sample = 0; sample < 300; ++sample) {
        const real a = uniform(random), b = uniform(random), c = uniform(random);
        const auto f = [&](real x, real y) { return a + b * x + c * y; };
        real exact = 0;
        const int strips = 2000;
        for (int i = 0; i < strips; ++i) {
            const real x = (i + 0.5) / strips;
            exact += fraction_positive(f(x, 0), f(x, 1)) / strips;
        }
        EXPECT_NEAR(fraction_positive({f(0, 0), f(1, 0), f(1, 1), f(0, 1)}), exact, 1e-3);  // midpoint rule across kinks: O(1/strips)
    }
}

TEST("open and closed fractions of the same corners add to one, saddles included") {
    std::mt19937 random(5);
    std::uniform_real_distribution<real> uniform(-1, 1);
    for (int sample = 0; sample < 1000; ++sample) {
        std::array<real, 4> v, opposite;
        for (std::size_t i = 0; i < 4; ++i) opposite[i] = -(v[i] = uniform(random));
        const real open = fraction_positive(v);
        EXPECT_GE(open, 0);
        EXPECT_LE(open, 1);
        EXPECT_NEAR(open + fraction_positive(opposite), 1, 1e-14);
    }
}

TEST("the fraction does not depend on how the square is turned or mirrored") {
    std::mt19937 random(6);
    std::uniform_real_distribution<real> uniform(-1, 1);
    for (int sample = 0; sample < 1000; ++sample) {
        const std::array<real, 4> v{uniform(random), uniform(random), uniform(random), uniform(random)};
        EXPECT_NEAR(fraction_positive(v), fraction_positive({v[1], v[2], v[3], v[0]}), 1e-14);
        EXPECT_NEAR(fraction_positive(v), fraction_positive({v[3], v[2], v[1], v[0]}), 1e-14);
    }
}

}  // namespace fractions_tests
