// Linear waves and Prosperetti's initial-value solution, against its table and its limits.
#include "validation/references/waves.hpp"

#include "support/test.hpp"
#include "validation/references/table.hpp"

namespace waves_tests {

using namespace weir;
using namespace weir::validation;

TEST("Prosperetti's solution reproduces the table to all its digits") {
    const Table table = read_table(std::filesystem::path(WEIR_SOURCE_DIR) / "cases/standing_wave/data/standing_wave_prosperetti.csv");
    ASSERT_GT(table.rows.size(), 90u);
    for (const auto& [column, nu] : {std::pair{"eps=0.01", 0.01}, std::pair{"eps=0.05", 0.05}})
        for (std::size_t i = 0; i < table.rows.size(); ++i)
            EXPECT_NEAR(prosperetti(table.number(i, "omega0_t"), nu, 1, 1, 1), table.number(i, column), 1e-9);  // ten digits are printed
}

// Values of the closed form, given to six digits.
TEST("two fluids of one viscosity: waves and growth as by Prosperetti 1981") {
    const real g = 9.81, k = 2 * pi, nu = 1e-3, beta = 700.0 / (701.0 * 701.0), omega2 = g * k * 699 / 701;
    const real period = 2 * pi / std::sqrt(omega2);
    const auto a = [&](real periods) { return prosperetti(periods * period, nu, k, std::sqrt(omega2), 1, beta); };
    EXPECT_NEAR(a(0.5), -0.971119, 1e-6);
    EXPECT_NEAR(a(1), 0.941497, 1e-6);
    EXPECT_NEAR(a(2), 0.886038, 1e-6);
    EXPECT_NEAR(a(5), 0.738300, 1e-6);
    EXPECT_NEAR(growth_rate(0.01, k, -omega2, beta), 7.220777, 1e-6);
    EXPECT_NEAR(growth_rate(nu, k, -g * k / 2, 3.0 / 16), 5.349355, 1e-6);
    EXPECT_EQ(growth_rate(nu, k, omega2, beta), 0);
}

TEST("it scales with amplitude, and with time and length") {
    const real k = 3, omega0 = 7, nu = 0.02 * omega0 / (k * k);
    for (real t : {0.1, 1.0, 4.0}) {
        EXPECT_NEAR(prosperetti(t, nu, k, omega0, 0.2), 0.2 * prosperetti(t, nu, k, omega0, 1), 1e-15);
        EXPECT_NEAR(prosperetti(t, nu, k, omega0, 1), prosperetti(omega0 * t, 0.02, 1, 1, 1), 1e-11);
    }
}

TEST("with little viscosity it is Lamb's wave: cos(w t) exp(-2 nu k^2 t)") {
    const real nu = 1e-5;  // corrections are of order (nu k^2 / w)^(1/2) in amplitude while the vortical layer grows: 2 sqrt 2 n^(3/2)
    for (real t = 0; t < 60; t += 0.7) EXPECT_NEAR(prosperetti(t, nu, 1, 1, 1), std::cos(t) * std::exp(-2 * nu * t), 4 * nu);
}

TEST("dispersion: deep water g k, shallow water g d k^2, ripples sigma k^3") {
    EXPECT_NEAR(wave_frequency(9.81, 2, 50), std::sqrt(9.81 * 2), 1e-12);
    EXPECT_NEAR(wave_frequency(9.81, 1e-4, 1), std::sqrt(9.81) * 1e-4, 1e-12);
    EXPECT_NEAR(wave_frequency(0, 3, 50, 0.07), std::sqrt(0.07 * 27), 1e-12);
    EXPECT_EQ(wave_frequency(9.81, 2, 50), wave_frequency(9.81, 2, 50, 0));
}

}  // namespace waves_tests
