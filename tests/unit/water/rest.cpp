// Water at rest stays at rest, wherever and however its surface cuts the cells.
#include "support.hpp"

namespace rest_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// Largest speed and largest error of the pressure after 20 steps, scaled by √(g H) and ρ g H.
template <int D>
void stays_at_rest(const Vec<D>& point, const Vec<D>& normal, const std::string& transfer) {
    water::Water<D> water(water_scene(at_rest<D>(point, normal, transfer)));
    for (int step = 0; step < 20; ++step) water.step(water.advised_dt());
    const real g = 9.81, depth = 0.5, rho = 1000;
    const Vec<D> n = normal / norm(normal);
    real speed = 0, error = 0;
    const auto& state = water.state();
    for_each_cell(state.cells.extent(), [&](const Index<D>& I) {
        if (state.cells(I) != poisson::Cell::fluid) return;
        const Vec<D> x = state.u.cell_centre(I);
        error = std::max(error, std::abs(state.p(I) - rho * g * dot(point - x, n)));
        for (int a = 0; a < D; ++a) speed = std::max({speed, std::abs(state.u[a](I)), std::abs(state.u[a](I + e<D>(a)))});
    });
    EXPECT_LT(speed, 1e-6 * std::sqrt(g * depth)) << transfer;  // the bound; measured 1e-9 and less
    EXPECT_LT(error, 1e-7 * rho * g * depth) << transfer;       // tolerance 1e-10 of the solve times the cells of depth, with room
    EXPECT_GT(state.p(Index<D>::constant(0)), 0.5 * rho * g * 0.3) << "the tank is not empty";
}

template <int D>
Vec<D> first(std::array<real, 3> v) {
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = v[static_cast<std::size_t>(d)];
    return x;
}

}  // namespace

TEST_IN_2D_AND_3D("a level surface between cells, in the middle of cells and at any tilt keeps water at rest, with every transfer") {
    const Vec<D> up = Vec<D>::unit(1), tilted = first<D>({0.6, 0.7, 0.2});
    for (const std::string transfer : {"grid", "pic", "flip", "apic"}) {
        stays_at_rest<D>(first<D>({0.6, 0.5, 0.4}), up, transfer);
        stays_at_rest<D>(first<D>({0.6, 0.53125, 0.4}), up, transfer);  // through cell centres: h = 1/16
        stays_at_rest<D>(first<D>({0.6, 0.5, 0.4}), tilted, transfer);
    }
}

TEST_IN_2D_AND_3D("liquid poured against walls has a level surface up to them: a box is as good as a half space") {
    auto text = at_rest<D>(first<D>({0.6, 0.52, 0.4}), Vec<D>::unit(1), "flip");
    const auto from = text.find("liquid"), to = text.find('\n', from);
    text.replace(from, to - from,
                 fmt::format("liquid = [ {{ shape = \"box\", min = {}, max = {} }} ]", list({"0.0", "0.0", "0.0"}, D),
                             list({"1.25", "0.52", "0.75"}, D)));
    water::Water<D> water(water_scene(text));
    for (int step = 0; step < 10; ++step) water.step(water.advised_dt());
    EXPECT_LT(std::sqrt(integral(water, "kinetic_energy") / 500), 1e-6 * std::sqrt(9.81 * 0.52));
    EXPECT_NEAR(integral(water, "top"), 0.52, 1e-9);
}

}  // namespace rest_tests
