#include "waves/stokes.hpp"
#include "unit/waves/support.hpp"

namespace stokes_tests {

using namespace weir;
using namespace weir::waves;

TEST("the second order is Stokes's: (k a^2/4)(3 - s^2)/s^3 of the second harmonic, s = tanh k d") {
    for (const real depth : {1.5, 3.0, infinity}) {
        const StokesWave wave{.g = 9.81, .depth = depth, .height = 0.2, .k = 2 * pi / 8, .order = 2};
        const Stokes stokes(wave);
        const real s = std::tanh(wave.k * depth), a = 0.1, second = wave.k * a * a / 4 * (3 - s * s) / (s * s * s);
        EXPECT_NEAR(stokes.motion(0, 0).moved[1], a + second, 1e-14);
        EXPECT_NEAR(stokes.motion(4, 0).moved[1], -a + second, 1e-14);
        EXPECT_NEAR(stokes.speed(), std::sqrt(9.81 / wave.k * s), 1e-14);
    }
}

TEST("steep waves in deep water are faster by the square of their steepness: c^2 = (g/k)(1 + (k a)^2 + ...)") {
    const StokesWave wave{.g = 9.81, .height = 0.2, .k = 1, .order = 5};
    const real e = 0.1;
    EXPECT_NEAR(std::pow(Stokes(wave).speed(), 2) / 9.81, 1 + e * e + 0.5 * e * e * e * e, 1e-6);  // the next term is of sixth order
}

TEST("crests are higher and sharper than troughs are deep, and the height is what was asked for") {
    const Stokes stokes({.g = 9.81, .depth = 2.0, .height = 0.6, .k = 2 * pi / 10});
    const real crest = stokes.motion(0, 0).moved[1], trough = stokes.motion(5, 0).moved[1];
    EXPECT_NEAR(crest - trough, 0.6, 1e-13);
    EXPECT_GT(crest, 1.2 * -trough);
}

TEST("the surface moves with the water: d eta/dt = v - u d eta/dx, to what the fifth order leaves") {
    Stokes stokes({.g = 9.81, .depth = 4.0, .height = 0.4, .k = 2 * pi / 10});  // k H/2 = 0.13: its sixth power is 4e-6
    const real h = 1e-4;
    for (const real x : {0.5, 2.0, 4.0, 7.7}) {
        stokes.set_time(h);
        const real after = stokes.motion(x, 0).moved[1];
        stokes.set_time(-h);
        const real before = stokes.motion(x, 0).moved[1];
        stokes.set_time(0);
        const real slope = (stokes.motion(x + h, 0).moved[1] - stokes.motion(x - h, 0).moved[1]) / (2 * h);
        const Vec<3> u = stokes.motion(x, 0).velocity;
        EXPECT_NEAR((after - before) / (2 * h), u[1] - u[0] * slope, 4e-6 * stokes.speed() * 10);  // coefficients of order ten
    }
}

}  // namespace stokes_tests
