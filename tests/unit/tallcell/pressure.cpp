// The projection on tall cells: what it must be (the uniform grid's, restricted), and what it must not do.
#include "tallcell/pressure.hpp"

#include "support.hpp"

namespace weir::test::pressure_tests {
namespace {

constexpr real round_off = 1e-11;  // 2^-53 times the some ten thousand terms that sums over a basin have, conditioned as its matrix is
const poisson::Options exact{.tolerance = 1e-14};

template <int D>
Index<D> basin_cells() {
    if constexpr (D == 2)
        return {12, 40};
    else
        return {7, 24, 6};
}

template <int D>
void set_any_knots(TallPressure<D>& tall, Basin<D>& basin, int longest) {
    tall.set_surface(basin.phi, basin.closed, basin.state, any_knots(basin, longest));
}

TEST_IN_2D_AND_3D("with a knot in every cell the matrix is the uniform grid's") {
    for (const bool cubes : {true, false}) {
        Vec<D> edges = Vec<D>::constant(0.25);
        if (!cubes) edges[0] = 0.4, edges[D - 1] *= 1.5;
        Basin<D> basin(basin_cells<D>(), 3, 0.8, 0.1, edges);
        TallPressure<D> tall(basin.frame, 1, exact);
        set_any_knots(tall, basin, 1);
        poisson::Operator<D> A;  // as water on the uniform grid has it: 1/θ where the surface cuts the line between two centres
        A.cells = basin.state.cells;
        for (int a = 0; a < D; ++a) {
            A.axis_weight[a] = edges[0] * edges[0] / (edges[a] * edges[a]);
            A.weight[static_cast<std::size_t>(a)] = Grid<real, D>(basin.state.u[a].extent());
            for_each_inner_face(basin.state.u, a, [&](const Index<D>& I) {
                const Index<D> J = I - e<D>(a);
                const bool above = A.cells(I) == poisson::Cell::fluid, below = A.cells(J) == poisson::Cell::fluid;
                const real cut = above ? 1 - basin.phi(J) / basin.phi(I) : 1 - basin.phi(I) / basin.phi(J);
                A.weight[static_cast<std::size_t>(a)](I) = above == below ? 1 : std::min(cut, 1 + 1 / thinnest);
            });
        }
        std::vector<real> q(static_cast<std::size_t>(tall.knots().count())), Aq(q.size());
        for (real& x : q) x = basin.uniform(-1, 1);
        tall.multiply(q, Aq);
        const Grid<real, D> p = interpolated(tall.layout(), tall.knots(), q);
        Grid<real, D> zero(basin.frame.cells), r(basin.frame.cells);
        poisson::residual(A, p, zero, r);
        const auto uniform = tested(tall.layout(), tall.knots(), r);
        const real h2 = basin.frame.h[0] * basin.frame.h[0];
        const real most = largest({A.axis_weight[0], A.axis_weight[1], A.axis_weight[D - 1]});
        for (std::size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(h2 * Aq[i], -uniform[i], 1e-12 * most * (1 + 1 / thinnest)) << i;
    }
}

TEST_IN_2D_AND_3D("the matrix of any knots is the uniform one between functions that are linear inside elements") {
    Basin<D> basin(basin_cells<D>(), 3);
    TallPressure<D> uniform(basin.frame, 1, exact), tall(basin.frame, 1, exact);
    set_any_knots(uniform, basin, 1);
    for (const int longest : {2, 5, 30}) {
        set_any_knots(tall, basin, longest);
        ASSERT_LT(tall.knots().count(), uniform.knots().count());
        std::vector<real> q(static_cast<std::size_t>(tall.knots().count())), Aq(q.size());
        for (real& x : q) x = basin.uniform(-1, 1);
        tall.multiply(q, Aq);
        const Grid<real, D> p = interpolated(tall.layout(), tall.knots(), q);
        const std::vector<real> fine = tested(uniform.layout(), uniform.knots(), p);
        std::vector<real> r(fine.size());
        uniform.multiply(fine, r);
        const std::vector<real> restricted = tested(tall.layout(), tall.knots(), interpolated(uniform.layout(), uniform.knots(), r));
        for (std::size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(Aq[i], restricted[i], 1e-13 * largest(Aq) * 30) << longest << ' ' << i;
    }
}

TEST_IN_2D_AND_3D("a pressure that is linear in space is reproduced, and what it drives stays at rest, whatever the knots") {
    Basin<D> basin(basin_cells<D>(), 3, 0.75, 0);
    Vec<D> slope = Vec<D>::constant(0.13);
    slope[1] = 1;
    for_each_cell(basin.frame.cells, [&](const Index<D>& I) {
        basin.phi(I) = dot(slope, basin.frame.centre(I)) - 0.7 * basin.frame.h[1] * basin.frame.cells[1];
    });
    for (const int longest : {1, 2, 7, 40}) {
        TallPressure<D> tall(basin.frame, 1, exact);
        set_any_knots(tall, basin, longest);
        for (int a = 0; a < D; ++a) basin.state.u[a].fill(9.81 * slope[a]);
        basin.stop_at_walls();
        tall.restrict_velocity(basin.state);
        tall.project(basin.phi, basin.state, 1);
        tall.spread(basin.state, 1);
        EXPECT_LT(std::sqrt(tall.energy(basin.phi, basin.state)), round_off * 9.81) << longest;
        EXPECT_LT(tall.max_divergence(basin.state) * basin.frame.h[0], round_off * 9.81) << longest;
        for_each_cell(basin.frame.cells, [&](const Index<D>& I) {
            if (basin.state.cells(I) != poisson::Cell::fluid) return;
            EXPECT_NEAR(basin.state.p(I), 9810 * basin.phi(I), round_off * 9810 * 10) << longest;
        });
    }
}

TEST_IN_2D_AND_3D("a projection leaves no divergence on the lattice, adds no energy, and done again changes nothing") {
    for (const int longest : {1, 3, 12, 40}) {
        Basin<D> basin(basin_cells<D>(), 3);
        TallPressure<D> tall(basin.frame, 1, exact);
        set_any_knots(tall, basin, longest);
        basin.stir();
        tall.restrict_velocity(basin.state);
        const real before = tall.energy(basin.phi, basin.state);
        tall.project(basin.phi, basin.state, 1);
        const real after = tall.energy(basin.phi, basin.state);
        EXPECT_LT(after, before);
        std::vector<real> b(static_cast<std::size_t>(tall.knots().count()));
        tall.weak_divergence(basin.state, b);
        EXPECT_LT(largest(b) * basin.frame.h[0], round_off) << longest;
        tall.spread(basin.state, 1);
        EXPECT_LT(tall.max_divergence(basin.state) * basin.frame.h[0], 100 * round_off) << longest << ": what inner rows add up to";
        const MacVelocity<D> once = basin.state.u;
        basin.state.p.fill(0);
        tall.restrict_velocity(basin.state);
        tall.project(basin.phi, basin.state, 1);
        EXPECT_LT(largest(tall.potential()), 100 * round_off) << longest;
        tall.spread(basin.state, 1);
        for (int a = 0; a < D; ++a)
            for (std::size_t i = 0; i < once[a].size(); ++i) ASSERT_NEAR(once[a][i], basin.state.u[a][i], 1e3 * round_off);
    }
}

TEST_IN_2D_AND_3D("other knots take over a flow without divergence: none appears, momentum stays, no energy is gained") {
    Basin<D> basin(basin_cells<D>(), 3);
    TallPressure<D> tall(basin.frame, 1, exact);
    set_any_knots(tall, basin, 9);
    basin.stir();
    tall.restrict_velocity(basin.state);
    tall.project(basin.phi, basin.state, 1);
    tall.spread(basin.state, 1);
    const auto momentum = [&] {
        Vec<D> sum{};
        for (int a = 0; a < D; ++a)
            sum[a] = sum_over(basin.frame.cells, [&](const Index<D>& I) {
                if (I[a] == 0) return 0.0;
                const bool wet = basin.state.cells(I) == poisson::Cell::fluid || basin.state.cells(I - e<D>(a)) == poisson::Cell::fluid;
                return wet ? basin.state.u[a](I) : 0;
            });
        return sum;
    };
    TallPressure<D> uniform(basin.frame, 1, exact);
    set_any_knots(uniform, basin, 1);
    uniform.restrict_velocity(basin.state);
    real energy = uniform.energy(basin.phi, basin.state);
    const Vec<D> carried = momentum();
    for (const int longest : {4, 20, 2, 40}) {
        set_any_knots(tall, basin, longest);
        tall.restrict_velocity(basin.state);
        std::vector<real> b(static_cast<std::size_t>(tall.knots().count()));
        tall.weak_divergence(basin.state, b);
        EXPECT_LT(largest(b) * basin.frame.h[0], 1e3 * round_off) << longest;
        EXPECT_LE(tall.energy(basin.phi, basin.state), energy * (1 + round_off)) << longest;
        tall.spread(basin.state, 1);
        for (int a = 0; a < D; ++a) EXPECT_NEAR(momentum()[a], carried[a], 1e3 * round_off) << longest;
        uniform.restrict_velocity(basin.state);
        energy = uniform.energy(basin.phi, basin.state);
    }
}

}  // namespace
}  // namespace weir::test::pressure_tests
