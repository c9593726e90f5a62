// The pressure's passes run along lines and skip what holds no liquid; here they are held against the same formulas face by face.
#include "water/pressure.hpp"
#include "support.hpp"

#include <algorithm>

namespace pressure_tests {

using namespace weir;
using namespace weir::water;
using poisson::Cell;

namespace {

/// A state with a wavy surface, arbitrary velocities, and whatever sides and solids the scene names.
template <int D>
struct Pool {
    MacState<D> state;
    Frame<D> frame;
    SolidPlacement<D> solids;
    LevelSet<D> surface;
    Grid<std::uint8_t, D> closed;
    Grid<real, D> curvature;

    explicit Pool(const scene::Scene& scene)
        : state(scene, FieldPlan{}),
          frame(state.u, state.sides),
          solids(scene.has("solids") ? geometry::Solids<D>(scene.root().tables("solids")) : geometry::Solids<D>(), state),
          surface(frame, 1),
          curvature(frame.cells) {
        if (solids.any()) {
            closed = Grid<std::uint8_t, D>(frame.cells);
            for_each_cell(frame.cells, [&](const Index<D>& I) { closed(I) = state.cells(I) == Cell::solid; });
            surface.set_closed(closed);
        }
        for_each_cell(frame.cells, [&](const Index<D>& I) { curvature(I) = 3 * std::sin(2.0 * I[0] + I[1]); });
        for (int a = 0; a < D; ++a)
            for_each_cell(state.u[a].extent(), [&](const Index<D>& I) { state.u[a](I) = std::sin(1.0 + a + 3 * I[0] + 2 * I[D - 1]); });
        sync_periodic(state.u, state.sides);
    }
    void fill_to(real level) {
        for_each_cell(frame.cells, [&](const Index<D>& I) {
            const Vec<D> x = frame.centre(I);
            surface.phi(I) = x[1] - level - 0.11 * std::sin(9 * x[0]);
        });
        surface.redistance();
    }
};

/// dt/ρ ∂p/∂x_a on a face, from the definition: θ is where φ is zero between a liquid cell and one of air, and there p = σ κ.
template <int D>
real gradient(const Pool<D>& pool, int a, const Index<D>& I, real sigma, const Grid<real, D>* curvature) {
    const auto& [state, frame, solids, surface, closed, kappa] = pool;
    const bool on_side = !frame.periodic(a) && (I[a] == 0 || I[a] == frame.cells[a]);
    const Index<D> lower = frame.near(I, a, -1), upper = frame.near(I, a, 0);
    const bool below = state.cells(lower) == Cell::fluid, above = state.cells(upper) == Cell::fluid;
    if (on_side) {
        const bool first = I[a] == 0;
        if (!state.sides.open(a, first ? 0 : 1) || !below) return 0;
        return (first ? 2 : -2) * state.p(lower) * frame.inv_h[a];
    }
    if (state.solid.any() && state.solid.open[static_cast<std::size_t>(a)](I) == 0) return 0;
    if ((!below && !above) || state.cells(lower) == Cell::solid || state.cells(upper) == Cell::solid) return 0;
    if (below && above) return (state.p(upper) - state.p(lower)) * frame.inv_h[a];
    const Index<D>&liquid = below ? lower : upper, &air = below ? upper : lower;
    const real theta = surface.phi(liquid) / (surface.phi(liquid) - surface.phi(air));
    const real p = curvature ? sigma * ((1 - theta) * (*curvature)(liquid) + theta * (*curvature)(air)) : 0;
    return (below ? 1 : -1) * (p - state.p(liquid)) / theta * frame.inv_h[a];
}

template <int D>
void agrees_with_definition(const std::string& more, bool tension, const std::string& periodic = "[]") {
    const std::string head =
        fmt::format("solver = \"mac_water\"\ndim = {}\ngrid = {{ cells = {}, size = {}, periodic = {} }}\ntime = {{ end = 1.0 }}\n", D,
                    test::list({"14", "12", "9"}, D), test::list({"1.4", "1.1", "0.9"}, D), periodic);
    const auto scene = test::water_scene(head + "liquid = [ { shape = \"plane\", point = " + test::list({"0.5", "0.5", "0.5"}, D) +
                                         ", normal = " + test::list({"0.0", "1.0", "0.0"}, D) + " } ]\n" + more);
    Pool<D> pool(scene);
    PoissonChoice choice;
    choice.options.tolerance = 1e-12;
    SurfacePressure<D> pressure(pool.frame, pool.state, choice);
    const real sigma = tension ? 0.7 : 0, dt = 0.01;
    const Grid<real, D>* curvature = tension ? &pool.curvature : nullptr;
    for (const real level : {0.8, 0.45}) {  // twice: what an earlier surface left behind must not matter
        pool.fill_to(level);
        pressure.set_surface(pool.surface, pool.closed, pool.state);
        const auto before = pool.state.u;
        pressure.project(pool.state, pool.surface, dt, sigma, curvature);
        for (int a = 0; a < D; ++a)
            for_each_cell(pool.state.u[a].extent(), [&](const Index<D>& I) {
                const real expected = before[a](I) - dt / pool.state.rho * gradient(pool, a, I, sigma, curvature);
                EXPECT_NEAR(pool.state.u[a](I), expected, 1e-12) << "face " << a << " of " << I[0] << " " << I[1];
            });
        const real largest = max_over(pool.frame.cells, [&](const Index<D>& I) {
            return pool.state.cells(I) == Cell::fluid ? std::abs(flux_divergence(pool.state, I)) : 0;
        });
        EXPECT_EQ(pressure.max_divergence(pool.state), largest);
        EXPECT_LT(largest, 1e-8);  // tolerance 1e-12 of a divergence of some 2 / h = 20, and as much again for the largest of 1500 cells
        pool.state.u = before;
    }
}

}  // namespace

TEST_IN_2D_AND_3D("projection subtracts the gradient of the ghost-fluid pressure on every face of liquid, and the divergence is gone") {
    const std::string solid = "solids = [ { shape = \"sphere\", centre = " + test::list({"0.7", "0.3", "0.4"}, D) + ", radius = 0.21 } ]\n";
    for (const bool tension : {false, true}) {
        agrees_with_definition<D>("", tension);
        agrees_with_definition<D>(solid, tension);
        agrees_with_definition<D>(solid, tension, "[\"x\"]");
        agrees_with_definition<D>("sides = { x_min = { kind = \"open\" }, y_max = { kind = \"open\" } }\n", tension);
    }
}

}  // namespace pressure_tests
