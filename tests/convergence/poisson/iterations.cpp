// Ceilings on iterations: what makes the multigrid a multigrid is that they do not grow with the size.
#include "benchmarks/poisson/problems.hpp"
#include "poisson/poisson.hpp"
#include "support/test.hpp"

using namespace weir;

namespace {

template <int D>
int iterations(const std::string& name, int n) {
    const auto problem = bench::make<D>(name, n);
    const auto solver = poisson::make_solver<D>("multigrid", {.tolerance = 1e-8, .max_iterations = 200});
    solver->setup(problem.A);
    Grid<real, D> p(problem.b.extent());
    const int count = solver->solve(p, problem.b).iterations;
    EXPECT_LE(bench::true_residual(problem, p), 1e-8) << name << ' ' << n;
    return count;
}

template <int D>
std::vector<int> sizes() {
    return D == 2 ? std::vector<int>{64, 100, 255, 512} : std::vector<int>{32, 45, 64, 96};
}

}  // namespace

TEST_IN_2D_AND_3D("box and wavy take at most 12 iterations at any size, with face weights too") {
    for (const int n : sizes<D>())
        for (const std::string name : {"box", "wavy", "box_weights", "wavy_weights"})
            EXPECT_LE(iterations<D>(name, n), 12) << name << ' ' << n;
}

TEST_IN_2D_AND_3D("walls, slits, blocks and face fractions of four magnitudes take at most 40 iterations") {
    for (const std::string name : {"rooms", "slits", "blocks", "fractions", "magnitudes", "bands"})
        EXPECT_LE(iterations<D>(name, D == 2 ? 256 : 64), 40) << name;
}

TEST_IN_2D_AND_3D("thin domains, lines of cells and flat cells take at most 16 iterations") {
    std::vector<Extent<D>> shapes;
    for (const int n : {1, 2, 3, 7}) {
        Extent<D> extent(Index<D>::constant(D == 2 ? 300 : 60));
        extent[0] = n;
        shapes.push_back(extent);
        std::swap(extent[0], extent[D - 1]);
        shapes.push_back(extent);
    }
    for (const auto& extent : shapes)
        for (const real stretch : {1.0, 0.04, 30.0}) {
            poisson::Operator<D> A;
            A.cells = Grid<poisson::Cell, D>(extent, poisson::Cell::fluid);
            A.axis_weight[1] = stretch;
            Grid<real, D> p(extent), b(extent);
            for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(0.37 * static_cast<real>(i * i % 1001));
            const auto solver = poisson::make_solver<D>("multigrid", {.tolerance = 1e-8, .max_iterations = 100});
            solver->setup(A);
            EXPECT_LE(solver->solve(p, b).iterations, 16) << extent[0] << " x " << extent[1] << ", weight " << stretch;
        }
}

TEST_IN_2D_AND_3D("periodic boxes of even, odd and prime lengths take at most 16 iterations") {
    for (const int n : {48, 50, 53}) {
        poisson::Operator<D> A;
        A.cells = Grid<poisson::Cell, D>(replicated(Index<D>::constant(n)), poisson::Cell::fluid);
        A.periodic.fill(true);
        Grid<real, D> p(A.cells.extent()), b(A.cells.extent());
        for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(0.37 * static_cast<real>(i * i % 1001));
        const auto solver = poisson::make_solver<D>("multigrid", {.tolerance = 1e-8, .max_iterations = 100});
        solver->setup(A);
        EXPECT_LE(solver->solve(p, b).iterations, 16) << n;
    }
}
