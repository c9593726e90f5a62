// Drops and patches: our integration against an independent one, the series against its differential equation.
#include "validation/references/drops.hpp"
#include "support/test.hpp"
#include "validation/references/table.hpp"

namespace drops_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// Largest difference of the axes to a table of an independent integration, whose digits end at 1e-9.
real worst_difference(const std::string& file, const std::string& time, real A0, real Omega) {
    const Table table = read_table(std::filesystem::path(WEIR_SOURCE_DIR) / "cases/sph_drop/data" / file);
    real worst = 0;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const Ellipse e = stretched({1, 1, A0}, Omega, table.number(i, time));
        worst = std::max({worst, std::abs(e.a - table.number(i, "a_x")), std::abs(e.b - table.number(i, "b_y"))});
    }
    return worst;
}

}  // namespace

TEST("the stretching and the oscillating drop are those of an independent integration") {
    EXPECT_LT(worst_difference("elliptical_drop.csv", "A0_t", 1, 0), 2e-9);
    EXPECT_LT(worst_difference("oscillating_drop.csv", "Omega_t", 0.5, 1), 1e-8);  // error of the fourth-order steps: (20/4000)^4
}

TEST("the rotating patch: lap p = 2 rho omega^2, no pressure on the sides, the published value in the centre") {
    const real h = 0.05;
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, std::pair{0.2, 0.1}}) {
        const real laplacian = (rotating_patch_pressure(x + h, y) + rotating_patch_pressure(x - h, y) + rotating_patch_pressure(x, y + h) +
                                rotating_patch_pressure(x, y - h) - 4 * rotating_patch_pressure(x, y)) /
                               (h * h);
        EXPECT_NEAR(laplacian, 2, 0.02);  // h^2 / 12 times fourth derivatives of order 10
    }
    EXPECT_NEAR(rotating_patch_pressure(0.5, 0.3), 0, 1e-12);
    EXPECT_NEAR(rotating_patch_pressure(0, 0), -0.1473427, 1e-6);
}

}  // namespace drops_tests
