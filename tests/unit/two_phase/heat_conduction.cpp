// Conduction through liquid and gas against closed forms.
#include "support.hpp"

namespace heat_conduction_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

/// Liquid below (or above) `level` along an axis of a unit box, n cells along it and 4 along the others, at rest.
template <int D>
scene::Scene layers(int axis, int n, real level, bool above, const std::string& more) {
    std::vector<std::string> cells(D, "4"), size(D, fmt::format("{}", 4.0 / n)), lo(D, "-1.0"), hi(D, "2.0");
    const auto at = static_cast<std::size_t>(axis);
    cells[at] = std::to_string(n), size[at] = "1.0", (above ? lo : hi)[at] = fmt::format("{}", level);
    return two_phase_scene(fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
effects = {{ heat = {{}} }}
{}
)",
                                       D, list(cells, D), list(size, D), list(lo, D), list(hi, D), more));
}

/// rho c and k of a liquid and a gas whose layers of diffusion are alike: 8 and 2, 1 and 0.5.
const char* const contact = R"(fluid = { density = 1000.0, heat_capacity = 0.008, conductivity = 2.0 }
gas = { density = 1.0, heat_capacity = 1.0, conductivity = 0.5 }
initial = { temperature = { name = "constant", value = 1.0 }, liquid_temperature = 3.0 }
)";

/// Two half-spaces of temperatures 3 and 1 in contact since t = 0, at distance s above the surface of the liquid (Carslaw & Jaeger 1959,
/// §2.15).
real half_spaces(real s, real t) {
    const real e_l = std::sqrt(2.0 * 8), e_g = std::sqrt(0.5 * 1), between = (e_l * 3 + e_g * 1) / (e_l + e_g);
    const real alpha = s < 0 ? 2.0 / 8 : 0.5 / 1, far = s < 0 ? 3 : 1;
    return between + (far - between) * std::erf(std::abs(s) / (2 * std::sqrt(alpha * t)));
}

/// The largest error of n cells at t = 0.01 in steps of h²/6.
template <int D>
real contact_error(int axis, int n, real level, bool above) {
    TwoPhase<D> solver(layers<D>(axis, n, level, above, contact));
    const real end = 0.01;
    const int steps = n * n * 6 / 100;
    for (int i = 0; i < steps; ++i) solver.step(end / steps);
    return max_over(temperature(solver).extent(), [&](const Index<D>& I) {
        const real s = (above ? -1 : 1) * (solver.state().u.cell_centre(I)[axis] - level);
        return std::abs(temperature(solver)(I) - half_spaces(s, end));
    });
}

}  // namespace

// Of second order in h and of first in dt = h²/6, so errors fall by four, or 3.5 with a rest of higher orders. 1% of the difference of 2 K:
// the layer in the liquid is √(4 α t) = 0.1 wide, four cells.
TEST_IN_2D_AND_3D("half-spaces in contact exchange heat as the closed form, wherever the surface stands in its cell") {
    for (int axis = 0; axis < D; ++axis)
        for (const bool above : {false, true})
            for (const real shift : {0.0, 0.25, 0.5, 0.8}) {
                const int n = 20;
                const real coarse = contact_error<D>(axis, n, 0.5 + shift / n, above),
                           fine = contact_error<D>(axis, 2 * n, 0.5 + shift / (2 * n), above);
                EXPECT_LT(fine, 0.02) << axis << above << shift;
                EXPECT_GT(coarse / fine, 3.5) << axis << above << shift;
            }
}

namespace {

/// The largest error within 0.2 of the middle of a box of n² cells, with a surface whose normal is at an angle to the axes.
real oblique_error(int n, real angle) {
    const Vec<2> normal{{std::cos(angle), std::sin(angle)}};
    TwoPhase<2> solver(two_phase_scene(fmt::format(R"(solver = "two_phase"
dim = 2
grid = {{ cells = [{0}, {0}], size = [1.0, 1.0] }}
time = {{ end = 1.0 }}
liquid = [ {{ shape = "plane", point = [0.5, 0.5], normal = [{1}, {2}] }} ]
effects = {{ heat = {{}} }}
{3}
)",
                                                   n, normal[0], normal[1], contact)));
    const real end = 0.01;
    const int steps = n * n * 6 / 100;
    for (int i = 0; i < steps; ++i) solver.step(end / steps);
    return max_over(temperature(solver).extent(), [&](const Index<2>& I) {
        const Vec<2> x = solver.state().u.cell_centre(I) - Vec<2>{{0.5, 0.5}};
        return norm(x) > 0.2 ? 0 : std::abs(temperature(solver)(I) - half_spaces(dot(normal, x), end));
    });
}

}  // namespace

// The conductivity of a face has no part across its axis, so errors in the cells of the surface are of first order: they fall by two,
// or 1.7.
TEST("half-spaces whose surface is oblique to the grid exchange heat as the closed form") {
    for (const real degrees : {20.0, 45.0, 110.0}) {
        const real angle = degrees * pi / 180;
        const real errors[] = {oblique_error(20, angle), oblique_error(40, angle), oblique_error(80, angle)};
        EXPECT_LT(errors[1], 0.02) << degrees;
        for (int i = 0; i < 2; ++i) EXPECT_GT(errors[i] / errors[i + 1], 1.7) << degrees;
    }
}

// Also the fluids in the cells of the surface, which is in the middle of cells here. The tolerance 1e-10 of the solve times the condition
// of the chain of cells, 16² · 4, is 1e-7 of 2 K.
TEST_IN_2D_AND_3D("liquid and gas in a closed box reach one temperature, that of their heat") {
    TwoPhase<D> solver(layers<D>(0, 16, 0.53, false, contact));
    const real heat = integral(solver, "heat");
    for (int i = 0; i < 3; ++i) solver.step(1e6);
    EXPECT_NEAR(integral(solver, "heat") / heat, 1, 1e-14);
    const real exact = (0.53 * 8 * 3 + 0.47 * 1 * 1) / (0.53 * 8 + 0.47 * 1);
    EXPECT_NEAR(integral(solver, "coldest"), exact, 2e-7);
    EXPECT_NEAR(integral(solver, "hottest"), exact, 2e-7);
}

// Films of a gas that insulates, far thinner than the divergence that the pressure leaves makes them, in every cell of a liquid that
// conducts: 1e-9 of a cell, as large as dust. Without them one step brings all to the mean of the walls.
TEST("films of a gas that insulates do not stop conduction in the liquid") {
    const auto scene = two_phase_scene(
        "solver = \"two_phase\"\ndim = 2\ngrid = { cells = [16, 4], size = [1.0, 0.25] }\ntime = { end = 1.0 }\n"
        "liquid = [ { shape = \"box\", min = [-1.0, -1.0], max = [2.0, 2.0] } ]\neffects = { heat = {} }\n"
        "fluid = { density = 1000.0, heat_capacity = 1.0, conductivity = 1.0 }\ngas = { density = 1.0, heat_capacity = 1.0 }\n"
        "initial.temperature = { name = \"constant\", value = 300.0 }\nsides.x_min = { kind = \"wall\", temperature = 400.0 }\n");
    const TwoPhase<2> solver(scene);
    const mac::MacState<2>& state = solver.state();
    mac::Padded<2> f(state.extent());
    two_phase::FractionGhosts<2>(state.sides, -1, {}).fill_all(f, Grid<real, 2>(state.extent(), 1 - 1e-9));
    auto faces = solver.face_fractions();
    for (auto& of_axis : faces) of_axis.fill(1 - 1e-9);
    Grid<real, 2> T(state.extent(), 300.0);
    two_phase::HeatConduction<2> conduction(state, {1000, 1}, {1, 0}, state.fields[1].boundary);
    conduction.apply(state, f, faces, 1e9, T);
    EXPECT_LT(mac::max_magnitude(T, 400), 1e-3);
}

// k_l/k_g = 25 and 1000:1 in ρc. In steps of 1e9 s the content of the cells is 1e-8 of what flows. The tolerance 1e-10 of the solve times
// the condition of the chain of cells, 16² · 25, is 6e-7 of 120 K.
TEST_IN_2D_AND_3D("the flux through two layers in series is exact, wherever the surface stands in its cell") {
    const char* const fluids = R"(fluid = { density = 1000.0, heat_capacity = 1.0, conductivity = 0.625 }
gas = { density = 1.0, heat_capacity = 1.0, conductivity = 0.025 }
initial.temperature = { name = "constant", value = 300.0 }
)";
    for (int axis = 0; axis < D; ++axis)
        for (const real level : {0.25, 0.31, 0.5, 0.623}) {
            const char x = "xyz"[axis];
            const std::string walls = fmt::format(
                "sides = {{ {}_min = {{ kind = \"wall\", temperature = 400.0 }}, {}_max = {{ kind = \"wall\", temperature = 280.0 }} }}\n",
                x, x);
            TwoPhase<D> solver(layers<D>(axis, 16, level, false, fluids + walls));
            for (int i = 0; i < 2; ++i) solver.step(1e9);
            const real added = integral(solver, "heat_added");
            solver.step(1e9);
            const real flux = (400 - 280) / (level / 0.625 + (1 - level) / 0.025), through = flux * 1e9 * std::pow(4.0 / 16, D - 1);
            EXPECT_NEAR((integral(solver, "heat_added") - added) / through, 0, 1e-6) << "what enters leaves";
            const real worst = max_over(temperature(solver).extent(), [&](const Index<D>& I) {
                const real at = solver.state().u.cell_centre(I)[axis];
                const real exact = at < level ? 400 - flux * at / 0.625 : 280 + flux * (1 - at) / 0.025;
                return std::abs(temperature(solver)(I) - exact);
            });
            EXPECT_LT(worst, 7e-5) << axis << " " << level;
        }
}

}  // namespace heat_conduction_tests
