// Van der Waals's fluid against a table of Maxwell's rule, and against the rule itself; the ideal gas as its thin limit.
#include "core/error.hpp"
#include "support/csv.hpp"
#include "support/test.hpp"
#include "thermo/substance.hpp"

namespace gases_tests {

using namespace weir;
using namespace weir::thermo;

namespace {

constexpr real R = 461.526;
constexpr Point top{647.096, 22.064e6};
constexpr Conduction liquid{4200, 0.6}, vapour{2000, 0.025};

real pressure_of(real rho, real T) {
    const real a = 27 * R * R * top.T * top.T / (64 * top.p), b = R * top.T / (8 * top.p);
    return rho * R * T / (1 - b * rho) - a * rho * rho;
}

}  // namespace

TEST("reduced coexistence agrees with the table to 1e-6") {
    const auto fluid = van_der_waals(R, top, liquid, vapour);
    const real rho_c = 8 * top.p / (3 * R * top.T);
    const auto rows = test::read_csv(WEIR_SOURCE_DIR "/cases/phase_diagram/data/van_der_waals_coexistence.csv");
    ASSERT_EQ(rows.size(), 7u);
    for (const auto& row : rows) {
        const real T = row[0] * top.T;
        EXPECT_NEAR(fluid->pressure(Boundary::saturation, T) / top.p, row[1], 1e-6 * row[1]) << row[0];
        EXPECT_NEAR(fluid->colder_density(Boundary::saturation, T) / rho_c, row[2], 1e-6 * row[2]) << row[0];
        EXPECT_NEAR(fluid->warmer_density(Boundary::saturation, T) / rho_c, row[3], 1e-6 * row[3]) << row[0];
        EXPECT_NEAR(fluid->temperature(Boundary::saturation, row[1] * top.p) / top.T, row[0], 1e-9);
    }
}

TEST("both states have the pressure of the balance, and the areas under the loop are equal") {
    const auto fluid = van_der_waals(R, top, liquid, vapour);
    const real a = 27 * R * R * top.T * top.T / (64 * top.p), b = R * top.T / (8 * top.p);
    for (real r = 0.3; r < 0.9999; r += 0.0137) {
        const real T = r * top.T, p = fluid->pressure(Boundary::saturation, T);
        const real l = fluid->colder_density(Boundary::saturation, T), v = fluid->warmer_density(Boundary::saturation, T);
        EXPECT_NEAR(pressure_of(v, T), p, 1e-11 * top.p);
        EXPECT_NEAR(pressure_of(l, T), p, 1e-11 * 27 * top.p);                        // the difference of two terms of up to 27 p_c
        const real area = R * T * std::log((1 / v - b) / (1 / l - b)) + a * (v - l);  // of p dv from liquid to vapour
        EXPECT_NEAR(area, p * (1 / v - 1 / l), 1e-11 * R * T);
        // u = c T - a rho for this fluid, so L = a (rho_l - rho_v) + p (v_v - v_l) beside Clapeyron's
        EXPECT_NEAR(fluid->latent_heat(Boundary::saturation, T), a * (l - v) + p * (1 / v - 1 / l), 1e-11 * R * top.T * 27 / 8);
        EXPECT_NEAR(fluid->latent_heat(Boundary::saturation, T), fluid->Substance::latent_heat(Boundary::saturation, T), 1e-9 * R * top.T);
        const real dT = 1e-5 * T, rise = fluid->pressure(Boundary::saturation, T + dT) - fluid->pressure(Boundary::saturation, T - dT);
        if (r > 0.99) continue;  // the step would pass the critical point
        EXPECT_NEAR(rise / (2 * dT), fluid->slope(Boundary::saturation, T), 1e-6 * 4 * top.p / top.T);
    }
}

TEST("densities lie on the equation of state, on the branch of the state asked for") {
    const auto fluid = van_der_waals(R, top, liquid, vapour);
    for (const Point at : {Point{500, 1e5}, Point{600, 5e6}, Point{700, 1e7}, Point{700, 4e7}, Point{600, 2.2e7}}) {
        const State state = fluid->state(at);
        const real rho = fluid->density(state, at);
        EXPECT_NEAR(pressure_of(rho, at.T), at.p, 1e-9 * at.p);
    }
    EXPECT_EQ(fluid->state({600, 5e6}), State::vapour);
    EXPECT_EQ(fluid->state({600, 2.2e7}), State::liquid);
    EXPECT_EQ(fluid->state({700, 2.3e7}), State::supercritical);
    EXPECT_EQ(fluid->state(top), State::supercritical);
}

TEST("the expansion of van der Waals's liquid is the slope of its density over the temperature, at the pressure of saturation") {
    const auto fluid = van_der_waals(R, top, liquid, vapour);
    for (const real part : {0.5, 0.7}) {
        const real T = part * top.T, eps = 1e-4 * T, p = fluid->pressure({}, T + eps);  // liquid at both ends
        const real slope = (fluid->density(State::liquid, {T + eps, p}) - fluid->density(State::liquid, {T - eps, p})) / (2 * eps);
        // The pressure is higher than that of saturation by 1e-4 T dp/dT: a part of 1e-3 of it, which a liquid hardly feels.
        EXPECT_NEAR(fluid->expansion(T), -slope / fluid->colder_density({}, T), 1e-3 * fluid->expansion(T));
    }
}

TEST("thin, van der Waals's fluid is the ideal gas, and that has no other state") {
    const auto fluid = van_der_waals(R, top, liquid, vapour), gas = ideal_gas(R, vapour);
    const Point thin{600, 10};
    // The second coefficient, b - a/(R T), is 4.5e-3 m^3/kg here: times the density, 3.6e-5 kg/m^3.
    EXPECT_NEAR(fluid->density(State::vapour, thin) / gas->density(State::vapour, thin), 1, 4.5e-3 * 3.7e-5);
    for (const real p : {1.0, 1e5, 1e9}) EXPECT_EQ(gas->state({10, p}), State::vapour);
    EXPECT_EQ(gas->heat_curve(1e5).states(), 1);
    EXPECT_EQ(gas->heat_curve(1e5).temperature(2000 * 300), 300);
    EXPECT_EQ(gas->expansion(250), 1.0 / 250);
}

TEST("a liquid boils at its pressure, above the critical one it does not") {
    const auto fluid = van_der_waals(R, top, liquid, vapour);
    const auto curve = fluid->heat_curve(5e6);
    ASSERT_EQ(curve.states(), 2);
    EXPECT_NEAR(fluid->pressure(Boundary::saturation, curve.begins_at(1)), 5e6, 1e-7);
    EXPECT_EQ(fluid->heat_curve(3e7).latent_heat(0), 0);
    EXPECT_THROW(van_der_waals(R, {0, 1e5}, liquid, vapour), BadInput);
    EXPECT_THROW(ideal_gas(0, vapour), BadInput);
}

}  // namespace gases_tests
