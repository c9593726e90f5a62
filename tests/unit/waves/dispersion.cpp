#include "waves/dispersion.hpp"
#include "unit/waves/support.hpp"
#include "waves/spectra.hpp"

namespace dispersion_tests {

using namespace weir;
using namespace weir::waves;

TEST("the wavenumber of a frequency is the one that has it, from ripples to tides") {
    for (const real depth : {0.01, 1.0, 50.0, infinity})
        for (const real k : {1e-4, 0.03, 1.0, 40.0, 2000.0})
            for (const real sigma : {0.0, 7.3e-5}) {
                const Restoring by{9.81, sigma};
                EXPECT_NEAR(wavenumber(by, frequency(by, k, depth), depth) / k, 1, 1e-13) << depth << ' ' << k;
            }
}

TEST("the group speed is the derivative of the frequency") {
    for (const real depth : {0.3, 5.0, infinity})
        for (const real k : {0.1, 1.0, 30.0}) {
            const Restoring by{9.81, 7.3e-5};
            const real h = 1e-5 * k, slope = (frequency(by, k + h, depth) - frequency(by, k - h, depth)) / (2 * h);
            EXPECT_NEAR(group_speed(by, k, depth) / slope, 1, 1e-8);  // (1e-5)^2 of the third derivative, and 1e-16/1e-5
        }
}

TEST("what is left of a wave below the surface is what hyperbolic functions say, also where they overflow") {
    for (const real y : {0.0, -0.3, -2.0}) {
        const Reach r = reach(1.5, y, 2.0);
        EXPECT_NEAR(r.along, std::cosh(1.5 * (y + 2)) / std::sinh(3.0), 1e-14);
        EXPECT_NEAR(r.up, std::sinh(1.5 * (y + 2)) / std::sinh(3.0), 1e-14);
    }
    EXPECT_NEAR(reach(2.0, -1.0, 1000.0).along, std::exp(-2.0), 1e-15);
    EXPECT_EQ(reach(2.0, 0.4, infinity).up, 1);
}

TEST("variances of the spectra: closed for Pierson and Moskowitz, quadrature of others for JONSWAP") {
    const Restoring by{9.81};
    const Spectrum pm = pierson_moskowitz(by, infinity, 15);
    EXPECT_NEAR(4 * std::sqrt(pm.variance()), 4.799, 5e-4);  // 2 U^2/g sqrt(0.0081/0.74)
    EXPECT_NEAR(pm.peak, 0.8772 * 9.81 / 15, 1e-4);
    EXPECT_NEAR(jonswap(by, infinity, 15, 1e5, 3.3).peak, 0.8807, 1e-4);  // 22 (g^2/(U F))^(1/3), Hasselmann et al. 1973
    // m0 wp^4/(alpha g^2) = 0.304990 and 0.445034 for gamma 3.3 and 7
    for (const auto& [gamma, known] : {std::pair{3.3, 0.304990}, {7.0, 0.445034}, {1.0, 0.2}}) {
        const Spectrum s = jonswap(by, infinity, 15, 1e5, gamma);
        EXPECT_NEAR(s.variance() * std::pow(s.peak, 4) / (s.alpha * by.g * by.g), known, 1e-6);
    }
}

TEST("a spectrum has the same variance in frequencies and in wavenumbers, and spreading integrates to one") {
    const Restoring by{9.81};
    for (const Spectrum& s : {pierson_moskowitz(by, infinity, 10), jonswap(by, 20, 10, 1e5, 3.3), phillips(by, infinity, 10, 8.1e-3)}) {
        real sum = 0;
        const real from = std::log(0.05 * s.peak_wavenumber()), to = std::log(1e4 * s.peak_wavenumber());
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            const real k = std::exp(from + (to - from) * (i + 0.5) / n);
            sum += s.of_wavenumber(k) * k * (to - from) / n;
        }
        EXPECT_NEAR(sum / s.variance(), 1, 1e-4);  // beyond 10^4 kp there is 1e-8 of it; in shallow water of 20 m 1e-5
    }
    for (const real s : {0.0, 1.0, 4.0, 50.0}) {
        real sum = 0;
        for (int i = 0; i < 1000; ++i) sum += Spreading(s)(2 * pi * (i + 0.5) / 1000) * 2 * pi / 1000;
        EXPECT_NEAR(sum, 1, 1e-9) << s;
    }
}

}  // namespace dispersion_tests
