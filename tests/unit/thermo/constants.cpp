// Substances of one's own: lines by Clausius and Clapeyron's equation.
#include "core/error.hpp"
#include "support/test.hpp"
#include "thermo/substance.hpp"

namespace constants_tests {

using namespace weir;
using namespace weir::thermo;

namespace {

/// Something between wax and water, heavier when solid.
Constants wax() {
    Constants k;
    k.triple = {300, 1000}, k.critical = {700, 2e6};
    k.fusion = 2e5, k.vaporisation = 1e6;
    k.solid_density = 900, k.liquid_density = 800;
    k.solid = {2000, 0.3}, k.liquid = {2500, 0.15}, k.vapour = {1500, 0.02};
    k.expansion = 8e-4;
    return k;
}
Constants icy() {
    Constants k = wax();
    k.solid_density = 700;
    return k;
}
Constants level() {
    Constants k = wax();
    k.solid_density = k.liquid_density;
    return k;
}

}  // namespace

TEST("the lines pass through the triple and the critical point, and their slopes are Clapeyron's") {
    for (const auto& k : {wax(), icy(), level()}) {
        const auto it = of_constants(k);
        for (const auto b : {Boundary::sublimation, Boundary::melting, Boundary::saturation}) {
            EXPECT_NEAR(it->pressure(b, 300), 1000, 1e-9);
            EXPECT_NEAR(it->temperature(b, 1000), 300, 1e-10);
        }
        EXPECT_NEAR(it->pressure(Boundary::saturation, 700), 2e6, 1e-12 * 2e6);
        for (const real T : {310.0, 450.0, 690.0}) {
            const real p = it->pressure(Boundary::saturation, T);
            // L = T dp/dT v of the vapour alone: the liquid's own volume is what Clausius's form of the equation neglects.
            EXPECT_NEAR(T * it->slope(Boundary::saturation, T) / it->density(State::vapour, {T, p}), 1e6, 1e-9 * 1e6);
            EXPECT_NEAR(it->temperature(Boundary::saturation, p), T, 1e-12 * T);
        }
    }
    const auto heavy = of_constants(wax());
    for (const real T : {300.0, 305.0})
        EXPECT_NEAR(heavy->Substance::latent_heat(Boundary::melting, T), 2e5, 1e-9 * 2e5);  // Clapeyron with slope and densities
}

TEST("sublimed is melted and boiled") {
    const auto it = of_constants(wax());
    EXPECT_EQ(it->latent_heat(Boundary::sublimation, 250),
              it->latent_heat(Boundary::melting, 300) + it->latent_heat(Boundary::saturation, 300));
}

TEST("pressure freezes what is heavier when solid, melts what is lighter, and does neither where both weigh the same") {
    EXPECT_EQ(of_constants(wax())->state({301, 1e4}), State::liquid);
    EXPECT_EQ(of_constants(wax())->state({301, 1e7}), State::solid);
    EXPECT_EQ(of_constants(icy())->state({299, 1e4}), State::solid);
    EXPECT_EQ(of_constants(icy())->state({299, 1e7}), State::liquid);
    for (const real p : {1e4, 1e7}) {
        EXPECT_EQ(of_constants(level())->state({299.999, p}), State::solid);
        EXPECT_EQ(of_constants(level())->state({300, p}), State::liquid);
    }
    for (const auto& k : {wax(), icy(), level()}) {
        const auto it = of_constants(k);
        EXPECT_EQ(it->state({299, 900}), State::vapour);
        EXPECT_EQ(it->state({299, 990}), State::solid);
        EXPECT_EQ(it->state({701, 2.1e6}), State::supercritical);
        EXPECT_EQ(it->state({701, 1.9e6}), State::vapour);
    }
}

TEST("the state is that of the heat curve at the same pressure") {
    for (const auto& k : {wax(), icy(), level()})
        for (const real p : {500.0, 2e3, 1e5, 1e6, 3e6})
            for (real T = 220.3; T < 800; T += 7.7) {
                const auto it = of_constants(k);
                const auto curve = it->heat_curve(p);
                EXPECT_EQ(curve.share(it->state({T, p}), curve.warmth(curve.enthalpy(T))), 1) << T << " K, " << p << " Pa";
            }
}

TEST("constants that no substance has are refused by name") {
    const auto first = [](auto change) {
        Constants k = wax();
        change(k);
        const auto list = faults(k);
        EXPECT_THROW(of_constants(k), BadInput);
        return list.empty() ? std::string("none") : list.front().constant + " " + list.front().message;
    };
    EXPECT_EQ(first([](auto& k) { k.triple.T = -3; }), "triple is -3 K, not above 0");
    EXPECT_EQ(first([](auto& k) { k.triple.T = 800; }), "triple is at 800 K, not below the critical point at 700 K");
    EXPECT_EQ(first([](auto& k) { k.triple.p = 3e6; }), "triple is at 3e+06 Pa, not below the critical point at 2e+06 Pa");
    EXPECT_EQ(first([](auto& k) { k.fusion = -1; }), "fusion is -1 J/kg, below 0");
    EXPECT_EQ(first([](auto& k) { k.vaporisation = 0; }), "vaporisation is 0 J/kg, not above 0");
    EXPECT_EQ(first([](auto& k) { k.liquid.heat_capacity = 0; }), "liquid.heat_capacity is 0 J/(kg K), not above 0");
    EXPECT_EQ(first([](auto& k) { k.fusion = 10; }),
              "fusion lets the solid melt at 3.4263e+14 K under the critical pressure, above the critical 700 K");
}

}  // namespace constants_tests
