// Enthalpy to temperature and back, through the plateaus of melting and boiling.
#include "thermo/heat_curve.hpp"

#include "support/test.hpp"
#include "thermo/substance.hpp"

namespace heat_curve_tests {

using namespace weir;
using namespace weir::thermo;

namespace {

constexpr real eps = std::numeric_limits<real>::epsilon();

/// Water under several pressures: below the triple point, at a low and the usual one, above the critical one.
std::vector<HeatCurve> curves() {
    std::vector<HeatCurve> list;
    for (const real p : {100.0, 2000.0, 101325.0, 5e6, 3e7}) list.push_back(water()->heat_curve(p));
    return list;
}

}  // namespace

TEST("enthalpy, warmth and enthalpy again differ by rounding, on lines and plateaus") {
    for (const auto& curve : curves())
        for (int i = 0; i <= 5000; ++i) {
            const real h = -1e6 + 1000.37 * i;
            // A few roundings of numbers no larger than |h| and the enthalpies and c T of the curve, 5e6 J/kg.
            EXPECT_NEAR(curve.enthalpy(curve.warmth(h)), h, 8 * eps * 5e6);
        }
}

TEST("temperature, enthalpy and temperature again differ by rounding") {
    for (const auto& curve : curves())
        for (real T = 100.1; T < 900; T += 0.731) EXPECT_NEAR(curve.temperature(curve.enthalpy(T)), T, 8 * eps * 5e6 / 1859) << T;
}

TEST("at the temperature of a plateau the enthalpy is that of the warmer state, and nothing of the colder is left") {
    const auto curve = water()->heat_curve(101325);
    ASSERT_EQ(curve.states(), 3);
    for (int i = 1; i < 3; ++i) {
        const real T = curve.begins_at(i);
        EXPECT_EQ(curve.enthalpy(T), curve.lowest(i));
        EXPECT_EQ(curve.share(curve.state(i), curve.warmth(curve.enthalpy(T))), 1);
        EXPECT_EQ(curve.share(curve.state(i - 1), curve.warmth(curve.highest(i - 1))), 1);
    }
}

TEST("half the heat of fusion melts half the ice, at the temperature of melting") {
    const auto curve = water()->heat_curve(101325);
    const Warmth half = curve.warmth(curve.highest(0) + 0.5 * curve.latent_heat(0));
    EXPECT_EQ(half.T, curve.begins_at(1));
    EXPECT_NEAR(curve.share(State::solid, half), 0.5, 1e-15);
    EXPECT_NEAR(curve.share(State::liquid, half), 0.5, 1e-15);
    EXPECT_EQ(curve.share(State::vapour, half), 0);
}

TEST("temperature never falls as enthalpy rises, and shares add up to one") {
    for (const auto& curve : curves()) {
        real last = 0;
        for (real h = -6e5; h < 4e6; h += 777.7) {
            const Warmth w = curve.warmth(h);
            EXPECT_GE(w.T, last);
            last = w.T;
            real all = 0;
            for (const State s : {State::solid, State::liquid, State::vapour, State::supercritical}) all += curve.share(s, w);
            EXPECT_NEAR(all, 1, 2 * eps);
        }
    }
}

TEST("without latent heat there is no plateau, and no division by it") {
    HeatCurve curve(State::solid, 2000, 300, 0);
    curve.then(State::liquid, 4000, 300, 0);
    EXPECT_EQ(curve.temperature(-2000), 299);
    EXPECT_EQ(curve.temperature(0), 300);
    EXPECT_EQ(curve.temperature(4000), 301);
}

}  // namespace heat_curve_tests
