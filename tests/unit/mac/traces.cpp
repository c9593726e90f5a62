// The fast paths of advection against the plain ones: traces of less than a cell, and MacCormack plane by plane.
#include "mac/advection/trace.hpp"

#include "core/parallel.hpp"
#include "mac/advection/advection.hpp"
#include "mac/grid/random_flow.hpp"
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

namespace weir::smoke::traces_tests {

namespace {

constexpr real speed = 1;

/// A random flow in a box that is periodic, closed, or open at its ends, with its ghosts. Rows are longer than two groups of lanes.
template <int D>
struct Stirred {
    explicit Stirred(const std::string& sides)
        : state(test::mac_scene(test::unit_box(D, 19, sides)), FieldPlan{}), trace(state.before, state.u, state.sides, "rk2") {
        state.before = PaddedVelocity<D>(state.u);
        set_random_flow(state.u, speed, 7);
        for (int a = 0; a < D; ++a) fill(state.before[a], state.u[a], boundary(a));
        for_each_cell(state.extent(), [&](const Index<D>& I) { state.p(I) = std::sin(3.1 * I[0] + 1.7 * I[1] * I[D - 1]); });
    }
    const Boundary<D>& boundary(int a) const { return state.boundary[static_cast<std::size_t>(a)]; }
    MacState<D> state;
    GridBacktrace<D> trace;
};

/// Hides that a trace is short.
template <int D>
struct Far final : Backtrace<D> {
    const Backtrace<D>& trace;
    explicit Far(const Backtrace<D>& of) : trace(of) {}
    void row(int home_axis, const Index<D>& first, int count, real dt, Displacement<D>& to) const override {
        trace.row(home_axis, first, count, dt, to);
    }
};

const char* const boxes[] = {
    "",
    "sides = { x_min = { kind = \"open\" }, y_max = { kind = \"open\" } }\n",
    R"(sides = { x_min = { kind = "periodic" }, x_max = { kind = "periodic" }, y_min = { kind = "periodic" }, y_max = { kind = "periodic" } }
)",
};

}  // namespace

TEST_IN_2D_AND_3D("traces of less than a cell agree with the general ones at every node, beside the sides too") {
    for (const char* box : boxes) {
        Stirred<D> flow(box);
        const GridBacktrace<D> any_length(flow.state.before, flow.state.u, flow.state.sides, "rk2");  // it knows of no largest rate
        const real rate = max_rate(flow.state.u);
        flow.trace.set_max_rate(rate);
        for (const real cells : {0.4, 0.99, -0.99})
            for (int home = -1; home < D; ++home) {
                const auto nodes = home < 0 ? all_cells<D>(flow.state.extent()) : free_faces(flow.state.u, flow.state.sides, home);
                for_each_row(nodes.lo, nodes.hi, [&](const Index<D>& first, int count) {
                    Displacement<D> general, fast;
                    any_length.row(home, first, count, cells / rate, general);
                    flow.trace.row(home, first, count, cells / rate, fast);
                    EXPECT_TRUE(fast.near && !general.near);
                    for (int d = 0; d < D; ++d) {
                        const real n = flow.state.sides.periodic(d) ? flow.state.u.cells[d] : infinity;  // the general one wraps
                        for (int i = 0; i < count; ++i) {
                            const real apart = std::abs(fast.d[d][i] - general.d[d][i]);
                            EXPECT_LE(std::min(apart, std::abs(apart - n)), 1e-13) << "home " << home << ", axis " << d << ", " << box;
                        }
                    }
                });
            }
    }
}

TEST_IN_2D_AND_3D("MacCormack plane by plane gives the bits of its two sweeps, for any number of threads") {
    for (const char* box : boxes) {
        Stirred<D> flow(box);
        const real rate = max_rate(flow.state.u), dt = 0.9 / rate;
        flow.trace.set_max_rate(rate);
        const PressurePush<D> push(flow.state, 1e-3);
        for (int a = 0; a < D; ++a) {
            const auto nodes = free_faces(flow.state.u, flow.state.sides, a);
            CharacteristicAdvection<D> method{AdvectionOptions()};
            auto planes = flow.state.u[a], sweeps = planes;
            method.advect(flow.state.before[a], flow.boundary(a), nodes, Far<D>(flow.trace), dt, sweeps, &push);
            for (const int count : {1, 2, 3, 64}) {
                set_threads(count);
                planes.fill(0);
                method.advect(flow.state.before[a], flow.boundary(a), nodes, flow.trace, dt, planes, &push);
                for_each_in(nodes.lo, nodes.hi,
                            [&](const Index<D>& I) { EXPECT_EQ(planes(I), sweeps(I)) << count << " threads, " << box; });
            }
            set_threads(1);
        }
    }
}

}  // namespace weir::smoke::traces_tests
