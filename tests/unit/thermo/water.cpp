// Water against the tables of cases/phase_diagram/data. They have eight digits or are rounded as stated: 1e-6 where nothing else is said.
#include "core/error.hpp"
#include "support/csv.hpp"
#include "support/test.hpp"
#include "thermo/substance.hpp"

namespace water_tests {

using namespace weir;
using namespace weir::thermo;

namespace {

const std::string data = WEIR_SOURCE_DIR "/cases/phase_diagram/data/";

void expect_close(real measured, real expected, real relative, const char* what, real T) {
    EXPECT_NEAR(measured, expected, relative * std::abs(expected)) << what << " at " << T << " K";
}

struct StateRow {
    Point at;
    std::string state;
};
std::vector<StateRow> states() {
    std::ifstream file(data + "states.csv");
    std::vector<StateRow> rows;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || !std::isdigit(static_cast<unsigned char>(line[0]))) continue;
        std::istringstream cells(line);
        std::string T, p, state;
        std::getline(cells, T, ','), std::getline(cells, p, ','), std::getline(cells, state, ',');
        rows.push_back({{std::stod(T), std::stod(p)}, state});
    }
    return rows;
}

}  // namespace

TEST("saturation: pressure, slope, densities and latent heat agree with the table to 1e-6") {
    const auto rows = test::read_csv(data + "water_saturation.csv");
    ASSERT_EQ(rows.size(), 16u);
    for (const auto& row : rows) {
        const real T = row[0];
        expect_close(water()->pressure(Boundary::saturation, T), row[1], 1e-6, "pressure", T);
        expect_close(water()->slope(Boundary::saturation, T), row[2], 1e-6, "slope", T);
        expect_close(water()->colder_density(Boundary::saturation, T), row[3], 1e-6, "liquid density", T);
        expect_close(water()->warmer_density(Boundary::saturation, T), row[4], 1e-6, "vapour density", T);
        expect_close(water()->latent_heat(Boundary::saturation, T), row[5], 1e-6, "latent heat", T);
        EXPECT_NEAR(water()->temperature(Boundary::saturation, row[1]), T, 1e-6 * T);
    }
}

TEST("sublimation and melting agree with the table to 1e-6, and their inverses with its temperatures") {
    const auto rows = test::read_csv(data + "water_sublimation_melting.csv");
    ASSERT_EQ(rows.size(), 16u);
    int melting = 0;
    for (const auto& row : rows) {
        const real T = row[0];
        expect_close(water()->pressure(Boundary::sublimation, T), row[1], 1e-6, "sublimation", T);
        EXPECT_NEAR(water()->temperature(Boundary::sublimation, row[1]), T, 1e-6 * T);
        if (std::isnan(row[2])) continue;
        ++melting;
        expect_close(water()->pressure(Boundary::melting, T), row[2], 1e-6, "melting", T);
        if (T == 251.165) continue;  // the end of the line, which the rounded pressure may miss
        EXPECT_NEAR(water()->temperature(Boundary::melting, row[2]), T, 1e-6 * T);
    }
    EXPECT_EQ(melting, 9);
}

TEST("boiling points agree with the table to 1e-6") {
    const auto rows = test::read_csv(data + "boiling_points.csv");
    ASSERT_EQ(rows.size(), 14u);
    for (const auto& row : rows) {
        const real T = water()->temperature(Boundary::saturation, row[0]);
        EXPECT_NEAR(T, row[1], 1e-6 * T);
        EXPECT_NEAR(T, row[3], 0.009);  // IF97's own equation: the two differ by 0.008 K at most, and its digits end at 1e-4
        expect_close(water()->colder_density(Boundary::saturation, T), row[5], 1e-6, "liquid density", T);
        expect_close(water()->latent_heat(Boundary::saturation, T), row[9], 1e-6, "latent heat", T);
    }
}

TEST("along the line of melting ice and water shrink each by its own compressibility") {
    const real warm = 272, cold = 262, rise = water()->pressure(Boundary::melting, cold) - water()->pressure(Boundary::melting, warm);
    // Of R10-06 and of IAPWS-95 at 0 °C [1/Pa]
    EXPECT_NEAR(std::log(water()->colder_density(Boundary::melting, cold) / water()->colder_density(Boundary::melting, warm)) / rise,
                1.1779e-10, 1e-14);
    EXPECT_NEAR(std::log(water()->warmer_density(Boundary::melting, cold) / water()->warmer_density(Boundary::melting, warm)) / rise,
                5.0885e-10, 1e-14);
}

TEST("each line's inverse gives back its temperature to rounding") {
    // Of p, rounding is 1e-16; T moves by p/(dp/dT) times that, less than T of it on these lines, melting near the triple point apart:
    // there 1e-16 of the terms of the sum, 1e6 p_t, is 1e-11 K at 13 MPa/K.
    for (const auto boundary : {Boundary::sublimation, Boundary::melting, Boundary::saturation}) {
        const auto [lo, hi] = water()->ends(boundary);
        for (int i = 1; i < 50; ++i) {
            const real T = lo + (hi - lo) * i / 50;
            EXPECT_NEAR(water()->temperature(boundary, water()->pressure(boundary, T)), T, 2e-11) << name_of(boundary);
        }
    }
}

TEST("forty states are on the right side of the lines") {
    const auto rows = states();
    ASSERT_EQ(rows.size(), 40u);
    for (const auto& row : rows) EXPECT_EQ(name_of(water()->state(row.at)), row.state) << row.at.T << " K, " << row.at.p << " Pa";
}

TEST("a hair beside each tabled point of a line there are the two states that meet there") {
    for (const auto& row : test::read_csv(data + "water_saturation.csv")) {
        EXPECT_EQ(water()->state({row[0], row[1] * (1 - 2e-6)}), State::vapour) << row[0];
        EXPECT_EQ(water()->state({row[0], row[1] * (1 + 2e-6)}), State::liquid) << row[0];
    }
    for (const auto& row : test::read_csv(data + "water_sublimation_melting.csv")) {
        if (row[0] == 273.16) continue;  // the triple point has a test of its own
        EXPECT_EQ(water()->state({row[0], row[1] * (1 - 2e-6)}), State::vapour) << row[0];
        EXPECT_EQ(water()->state({row[0], row[1] * (1 + 2e-6)}), State::solid) << row[0];
        if (std::isnan(row[2]) || row[0] < 251.2) continue;
        EXPECT_EQ(water()->state({row[0], row[2] * (1 - 2e-6)}), State::solid) << row[0];
        EXPECT_EQ(water()->state({row[0], row[2] * (1 + 2e-6)}), State::liquid) << row[0];
    }
}

TEST("the three lines meet in the triple point, and the densities in the critical one") {
    const Point triple = *water()->triple(), critical = *water()->critical();
    for (const auto boundary : {Boundary::sublimation, Boundary::melting})
        EXPECT_NEAR(water()->pressure(boundary, triple.T), triple.p, 1e-9);
    EXPECT_NEAR(water()->pressure(Boundary::saturation, triple.T), triple.p, 1e-6 * triple.p);
    EXPECT_EQ(water()->pressure(Boundary::saturation, critical.T), critical.p);
    EXPECT_EQ(water()->colder_density(Boundary::saturation, critical.T), 322);
    EXPECT_EQ(water()->warmer_density(Boundary::saturation, critical.T), 322);
    EXPECT_EQ(water()->state(critical), State::supercritical);
}

TEST("what is sublimed has taken up the heats of fusion and vaporisation, to the spread of published values") {
    const real T = water()->triple()->T;
    const real both = water()->latent_heat(Boundary::melting, T) + water()->latent_heat(Boundary::saturation, T);
    EXPECT_NEAR(water()->latent_heat(Boundary::sublimation, T), both, 2e3);  // 2834 to 2836 kJ/kg are found in print
    EXPECT_NEAR(water()->latent_heat(Boundary::melting, T), 333.43e3, 30);   // IAPWS R10-06: five digits
}

TEST("the enthalpies of saturation differ by Clapeyron's heat, and give a closed vessel its internal energy") {
    std::ifstream file(data + "closed_vessel.csv");
    int compared = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.find("two-phase") == std::string::npos || line[0] == '#') continue;
        std::vector<real> cell;
        std::istringstream cells(line);
        for (std::string text; std::getline(cells, text, ',');) cell.push_back(text == "two-phase" ? 0 : std::stod(text));
        const real T = cell[1], x = cell[4];
        const auto s = water_at_saturation(T);
        EXPECT_NEAR(s.vapour_enthalpy - s.liquid_enthalpy, water()->latent_heat(Boundary::saturation, T), 1e-9 * 2.5e6);
        const real u = (1 - x) * (s.liquid_enthalpy - s.p / s.liquid_density) + x * (s.vapour_enthalpy - s.p / s.vapour_density);
        EXPECT_NEAR(u, cell[11], 5e-6 * cell[11]);  // the table's six digits
        ++compared;
    }
    EXPECT_EQ(compared, 14);
}

TEST("steam that is hotter than saturation lies between the saturated and the ideal gas") {
    const real Z = 2.07777e6 / (461.526 * 500 * 10);                                         // IF97, region 2: 10 kg/m^3 at 500 K
    EXPECT_NEAR(water()->density(State::vapour, {500, 2.07777e6}), 10, 0.2 * (1 - Z) * 10);  // what the power of T leaves of 1 - Z
    const real T = water()->temperature(Boundary::saturation, 101325);
    EXPECT_NEAR(water()->density(State::vapour, {T, 101325}), water()->warmer_density(Boundary::saturation, T), 1e-10);
    EXPECT_NEAR(water()->density(State::vapour, {3000, 101325}), 101325 / (461.526 * 3000), 3e-4 * 0.07);
}

TEST("the liquid's mean heat capacity is that of its enthalpies, and it is densest near 4 degrees") {
    const real T0 = water()->triple()->T, T1 = water()->temperature(Boundary::saturation, 101325);
    const real mean = (water_at_saturation(T1).liquid_enthalpy - water_at_saturation(T0).liquid_enthalpy) / (T1 - T0);
    EXPECT_NEAR(water()->conduction(State::liquid).heat_capacity, mean, 0.01);  // it is given with six digits
    EXPECT_LT(water()->expansion(275), 0);
    EXPECT_GT(water()->expansion(279), 0);
    EXPECT_NEAR(water()->expansion(293.15), 2.0664991e-4, 1e-10);  // differences of the density, in another program
}

TEST("what the formulas do not reach is refused, with the limit") {
    const auto refusal = [](auto&& call) {
        try {
            call();
        } catch (const BadInput& error) {
            return std::string(error.what());
        }
        return std::string("nothing was refused");
    };
    EXPECT_EQ(refusal([] { water()->state({-1, 1e5}); }), "a temperature of -1 K: it must be greater than 0 K");
    EXPECT_EQ(refusal([] { water()->state({300, 0}); }), "a pressure of 0 Pa: it must be greater than 0 Pa");
    EXPECT_EQ(refusal([] { water()->state({20, 1e5}); }), "a temperature of 20 K: the formulas of water begin at 50 K");
    EXPECT_EQ(refusal([] { water()->heat_curve(3e8); }), "a pressure of 3e+08 Pa: the formulas of water end at 2.08567e+08 Pa");
    EXPECT_EQ(refusal([] { water()->temperature(Boundary::saturation, 3e7); }),
              "the saturation line of water does not reach 3e+07 Pa: it runs from 611.657 to 2.2064e+07 Pa");
}

TEST("the state is that of the heat curve at the same pressure, beside every line") {
    for (const real p : {1e-3, 50.0, 611.6, 611.65703, 612.0, 5e3, 101325.0, 1e7, 22.064e6, 1e8, 2e8})
        for (real T = 150.3; T < 800; T += 3.7) {
            const auto curve = water()->heat_curve(p);
            EXPECT_EQ(curve.share(water()->state({T, p}), curve.warmth(curve.enthalpy(T))), 1) << T << " K, " << p << " Pa";
        }
}

}  // namespace water_tests
