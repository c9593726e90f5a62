// Every method on arbitrary cells, weights and sides gives the answer of a dense eigenvalue decomposition, and an honest report.
#include "poisson/poisson.hpp"

#include "core/error.hpp"
#include "problems.hpp"
#include "support/test.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>

namespace methods_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// All methods, without PETSc's where this weir has none (the test below says so).
std::vector<poisson::Method> methods_here() {
    std::vector<poisson::Method> here;
    for (const auto& method : poisson::methods())
        if (!method.needs_petsc || poisson::has_petsc()) here.push_back(method);
    return here;
}

poisson::Options to(real tolerance) { return {.tolerance = tolerance, .max_iterations = 100000}; }

/// The least-squares solution of least norm in each closed component: A⁺ b, by columns of `residual` itself.
template <int D>
Grid<real, D> dense_answer(const Operator<D>& A, const Grid<real, D>& b) {
    const auto n = static_cast<Eigen::Index>(A.cells.size());
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    Grid<real, D> unit(A.cells.extent()), zero(A.cells.extent()), column;
    for (Eigen::Index j = 0; j < n; ++j) {
        const auto at = static_cast<std::size_t>(j);
        if (A.cells[at] != Cell::fluid) continue;
        unit[at] = 1;
        poisson::residual(A, unit, zero, column);
        unit[at] = 0;
        for (Eigen::Index i = 0; i < n; ++i) M(i, j) = -column[static_cast<std::size_t>(i)];
    }
    EXPECT_EQ((M - M.transpose()).cwiseAbs().maxCoeff(), 0) << "the matrix is symmetric";
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(M);
    Eigen::VectorXd rhs(n);
    for (Eigen::Index i = 0; i < n; ++i) rhs(i) = A.cells[static_cast<std::size_t>(i)] == Cell::fluid ? b[static_cast<std::size_t>(i)] : 0;
    Eigen::VectorXd y = eigen.eigenvectors().transpose() * rhs;
    for (Eigen::Index i = 0; i < n; ++i) y(i) = eigen.eigenvalues()(i) > 1e-9 ? y(i) / eigen.eigenvalues()(i) : 0;
    const Eigen::VectorXd x = eigen.eigenvectors() * y;
    Grid<real, D> p(A.cells.extent());
    for (Eigen::Index i = 0; i < n; ++i) p[static_cast<std::size_t>(i)] = x(i);
    return p;
}

template <int D>
void expect_dense_answer(const Operator<D>& A, unsigned seed, const std::string& what) {
    const auto b = random_values<D>(A.cells.extent(), seed + 1000);
    const auto expected = dense_answer(A, b);
    for (const auto& method : methods_here()) {
        if (method.whole_box_only) continue;
        const auto solver = poisson::make_solver<D>(method.name, to(1e-11));
        solver->setup(A);
        auto p = random_values<D>(A.cells.extent(), seed + 2000);  // any first guess
        const auto& report = solver->solve(p, b);
        // The error is at most the condition number (below 1e4 for these small problems) times the residual.
        EXPECT_LT(largest_difference(p, expected), 1e-7 * std::max<real>(1, largest(expected))) << method.name << " on " << what;
        EXPECT_TRUE(report.converged && report.residual_after <= 1e-11) << method.name << " on " << what;
    }
}

}  // namespace

TEST_IN_2D_AND_3D("every method agrees with a dense decomposition on random cells") {
    const auto extent = D == 2 ? extent_of<D>(9, 7, 1) : extent_of<D>(5, 4, 6);
    for (unsigned seed = 1; seed <= 4; ++seed) {
        Chances chances{.solid = 0.1 * seed, .air = seed % 2 ? 0.1 : 0.0};
        expect_dense_answer(random_operator<D>(extent, seed, chances), seed, "flags, seed " + std::to_string(seed));
    }
}

TEST_IN_2D_AND_3D("every method agrees with a dense decomposition on random face weights and open sides") {
    const auto extent = D == 2 ? extent_of<D>(8, 9, 1) : extent_of<D>(4, 5, 6);
    for (unsigned seed = 1; seed <= 4; ++seed) {
        Chances chances{.solid = 0.15, .air = seed % 2 ? 0.1 : 0.0, .weights = true, .closed_face = 0.2, .sides = seed > 2};
        expect_dense_answer(random_operator<D>(extent, seed, chances), seed, "weights, seed " + std::to_string(seed));
    }
}

TEST_IN_2D_AND_3D("periodic axes of even, odd and least lengths, and cells that are not cubes") {
    for (const int n : {1, 2, 3, 5, 8}) {
        for (const bool weights : {false, true}) {
            Chances chances{.solid = 0.1, .air = n % 2 ? 0.1 : 0.0, .weights = weights, .sides = true};
            auto A = random_operator<D>(extent_of<D>(n, 6, 3), static_cast<unsigned>(n), chances);
            A.periodic[0] = true;
            A.periodic[D - 1] = n % 3 == 0;
            A.axis_weight[0] = 4;
            A.axis_weight[1] = 0.25;
            expect_dense_answer(A, 5, "periodic, n = " + std::to_string(n) + (weights ? " with weights" : ""));
        }
    }
}

TEST_IN_2D_AND_3D("many isolated cells, and cells between nothing but air or solid, are no special case") {
    auto A = box<D>(6);
    for_each_cell<D>(A.cells.extent(), [&](const Index<D>& I) {
        int parity = 0;
        for (int a = 0; a < D; ++a) parity += I[a];
        if (parity % 2 == 1) A.cells(I) = I[0] < 3 ? Cell::solid : Cell::air;
    });
    expect_dense_answer(A, 3, "a checkerboard");
}

TEST_IN_2D_AND_3D("a single cell, and no fluid at all") {
    for (const Cell kind : {Cell::fluid, Cell::solid, Cell::air}) {
        Operator<D> A;
        A.cells = Grid<Cell, D>(replicated(Index<D>::constant(1)), kind);
        for (const auto& method : methods_here()) {
            if (method.whole_box_only && kind != Cell::fluid) continue;
            const auto solver = poisson::make_solver<D>(method.name, {});
            solver->setup(A);
            Grid<real, D> p(A.cells.extent(), 7), b(A.cells.extent(), 3);
            solver->solve(p, b);
            EXPECT_EQ(p[0], 0) << method.name;
        }
    }
}

TEST_IN_2D_AND_3D("the report's residual is that of the answer given back, and pressure outside fluid is zero") {
    const auto A = random_operator<D>(extent_of<D>(13, 9, 7), 11, {.solid = 0.2, .air = 0.1});
    const auto b = random_values<D>(A.cells.extent(), 12);
    for (const auto& method : methods_here()) {
        if (method.whole_box_only) continue;
        const auto solver = poisson::make_solver<D>(method.name, {.tolerance = 1e-9, .max_iterations = 100000, .record_history = true});
        solver->setup(A);
        Grid<real, D> p(A.cells.extent()), r;
        const auto& report = solver->solve(p, b);
        poisson::residual(A, p, b, r);
        real outside = 0;
        for (std::size_t i = 0; i < p.size(); ++i)
            if (A.cells[i] != Cell::fluid) outside += std::abs(p[i]);
        EXPECT_EQ(outside, 0) << method.name;
        if (report.components == 0) {
            EXPECT_NEAR(largest(r), report.residual_max, 1e-13) << method.name;
        }
        EXPECT_EQ(static_cast<int>(report.history.size()), report.iterations) << method.name;
        EXPECT_GT(report.bytes, 0u) << method.name;
    }
}

TEST("a solve that misses its tolerance is an error, unless the iterations were fixed") {
    const auto A = box<2>(96);
    const auto b = random_values<2>(A.cells.extent(), 4);
    for (const auto& method : methods_here()) {
        if (!method.iterative) continue;
        Grid<real, 2> p(A.cells.extent());
        const auto strict = poisson::make_solver<2>(method.name, {.tolerance = 1e-10, .max_iterations = 2});
        strict->setup(A);
        EXPECT_THROW(strict->solve(p, b), NumericalFailure) << method.name;
        p.fill(0);
        const auto fixed = poisson::make_solver<2>(method.name, {.tolerance = 1e-10, .max_iterations = 2, .fixed_iterations = true});
        fixed->setup(A);
        const auto& report = fixed->solve(p, b);
        EXPECT_EQ(report.iterations, 2) << method.name;
        EXPECT_FALSE(report.converged) << method.name;
        EXPECT_LT(report.residual_after, report.residual_before) << method.name;
    }
}

TEST_IN_2D_AND_3D("more fixed iterations than round-off leaves work for end in the answer, from any guess") {
    auto A = box<D>(8);
    for_each_cell<D>(A.cells.extent(), [&](const Index<D>& I) {
        if (I[0] == 7) A.cells(I) = Cell::air;  // so that the pressure is unique
    });
    const auto b = random_values<D>(A.cells.extent(), 9);
    for (const auto& method : methods_here()) {
        if (!method.iterative) continue;
        const auto solver = poisson::make_solver<D>(method.name, {.max_iterations = 5000, .fixed_iterations = true});
        solver->setup(A);
        auto p = random_values<D>(A.cells.extent(), 11);
        for (int again = 0; again < 3; ++again)  // the second and third time from the answer itself
            // Round-off of b - A p relative to b: condition number 1e3, 1e-16 an operation.
            EXPECT_LT(solver->solve(p, b).residual_after, 1e-11) << method.name << ", solve " << again;
    }
}

TEST("a right-hand side that is not finite is an error for every method") {
    const auto A = box<2>(8);
    Grid<real, 2> b(A.cells.extent());
    b[5] = std::nan("");
    for (const auto& method : methods_here()) {
        const auto solver = poisson::make_solver<2>(method.name, {.fixed_iterations = true});
        solver->setup(A);
        Grid<real, 2> p(A.cells.extent());
        EXPECT_THROW(solver->solve(p, b), NumericalFailure) << method.name;
    }
}

TEST("the cosine transform is content with what rounding leaves of a direct solve, as CHOLMOD is; what is worse stays an error") {
    const auto A = box<2>(256);
    std::mt19937 gen(5);
    std::uniform_real_distribution<real> u(-1, 1);
    Grid<real, 2> b(A.cells.extent()), p(A.cells.extent()), exact(A.cells.extent());
    for (int j = 0; j < 256; ++j)  // smooth: |A| |p| is 1e5 |b|, so that 1e-12 is out of reach
        for (int i = 0; i < 256; ++i) b(Index<2>{{i, j}}) = std::cos(pi * (i + 0.5) / 256) + 1e-3 * u(gen);
    const auto solver = poisson::make_solver<2>("dct", {.tolerance = 1e-12});
    solver->setup(A);
    const auto report = solver->solve(p, b);
    EXPECT_TRUE(report.converged);
    EXPECT_GT(report.residual_after, 1e-12);  // else this test tests nothing
    EXPECT_LT(report.residual_after, 1e-9);   // 1e5 epsilon times 60 for the transforms' log2
    const auto direct = poisson::make_solver<2>("cholmod", {.tolerance = 1e-9});
    direct->setup(A);
    direct->solve(exact, b);
    real largest = 0, difference = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        largest = std::max(largest, std::abs(exact[i]));
        difference = std::max(difference, std::abs(p[i] - exact[i]));
    }
    EXPECT_LT(difference, 1e-8 * largest);
    b[7] = std::numeric_limits<real>::quiet_NaN();
    EXPECT_THROW(solver->solve(p, b), NumericalFailure);
}

TEST("an unknown method is refused and the known ones are named; so is a box that the cosine transform cannot solve") {
    std::string known;
    for (const auto& method : poisson::methods()) known += (known.empty() ? "" : ", ") + method.name;
    try {
        poisson::make_solver<2>("multgrid", {});
        FAIL() << "accepted";
    } catch (const BadInput& e) {
        EXPECT_EQ(e.what(), "unknown pressure method \"multgrid\"; known: " + known);
    }
    auto A = box<2>(4);
    A.cells[3] = Cell::air;
    EXPECT_THROW(poisson::make_solver<2>("dct", {})->setup(A), BadInput);
}

// The multigrid against a solver none of whose arithmetic is ours, where no dense decomposition reaches: two closed rooms and open water,
// cut faces, 30,000 to 60,000 unknowns.
TEST_IN_2D_AND_3D("PETSc, an independent referee, agrees with the multigrid on water among walls") {
    if (!poisson::has_petsc()) GTEST_SKIP() << "built without PETSc";
    const auto extent = D == 2 ? extent_of<D>(256, 160, 1) : extent_of<D>(40, 32, 36);
    auto A = random_operator<D>(extent, 21, {.solid = 0.05, .air = 0, .weights = true, .closed_face = 0.1});
    for_each_cell<D>(extent, [&](const Index<D>& I) {
        if (I[0] == 10 || I[0] == 25) A.cells(I) = Cell::solid;
        if (I[0] > 25 && I[1] > 20) A.cells(I) = Cell::air;
    });
    const auto b = random_values<D>(extent, 22);
    Grid<real, D> ours(extent);
    const auto multigrid = poisson::make_solver<D>("multigrid", to(1e-12));
    multigrid->setup(A);
    EXPECT_GT(multigrid->solve(ours, b).components, 1);
    for (const char* name : {"petsc_gamg", "petsc_boomeramg", "petsc_icc"}) {
        Grid<real, D> theirs(extent);
        const auto referee = poisson::make_solver<D>(name, to(1e-12));
        referee->setup(A);
        const auto& report = referee->solve(theirs, b);
        // Residuals of 1e-12 times the condition number, which is below 1e5 for some 200 cells across.
        EXPECT_LT(largest_difference(ours, theirs), 1e-7 * largest(ours)) << name << ", " << report.iterations << " iterations";
    }
}

namespace {

/// n × n cells of fluid in a ring of air, p = 0 at its cells' centres.
Operator<2> in_air(int n) {
    Operator<2> A;
    A.cells = Grid<Cell, 2>(replicated(Index<2>::constant(n + 2)), Cell::fluid);
    for_each_cell<2>(A.cells.extent(), [&](const Index<2>& I) {
        for (int a = 0; a < 2; ++a)
            if (I[a] == 0 || I[a] == n + 1) A.cells(I) = Cell::air;
    });
    return A;
}

}  // namespace

/// Young 1971: in natural order and in red-black order Gauss-Seidel leaves μ² of an error per iteration, μ = cos(π/(n + 1)) the largest
/// eigenvalue of Jacobi's iteration. Overrelaxed it would leave far less, damped more.
TEST("red-black Gauss-Seidel converges at the rate of theory") {
    const int n = 16;
    const auto A = in_air(n);
    Grid<real, 2> mode(A.cells.extent()), zero(A.cells.extent()), b;
    const real k = std::numbers::pi / (n + 1);
    for_each_cell<2>(A.cells.extent(), [&](const Index<2>& I) { mode(I) = std::sin(k * I[0]) * std::sin(k * I[1]); });
    poisson::residual(A, mode, zero, b);
    for (auto& v : b.values()) v = -v;
    const auto error = [&](int iterations) {
        const auto solver = poisson::make_solver<2>("red_black", {.max_iterations = iterations, .fixed_iterations = true});
        solver->setup(A);
        Grid<real, 2> p(A.cells.extent());
        solver->solve(p, b);
        return largest_difference(p, mode);
    };
    EXPECT_NEAR(std::pow(error(60) / error(40), 1.0 / 20), std::cos(k) * std::cos(k), 1e-3);  // a mode is met from the first iterations on
}

/// Gustafsson 1978: with what is dropped added to the diagonal, the condition number grows as the number n of cells across, without it as
/// n², as that of the diagonal. So the diagonal's iterations over these grow with n, at most by 2 from 40 to 160 cells (less, since 3% of
/// what is dropped is not added), and without it they do not grow: 10% are more than counts of some 30 and 80 iterations round.
TEST("modified incomplete Cholesky gains on the diagonal as grids grow") {
    const auto iterations = [&](const char* method, int n) {
        const auto A = in_air(n);
        const auto solver = poisson::make_solver<2>(method, {.tolerance = 1e-8});
        solver->setup(A);
        Grid<real, 2> p(A.cells.extent());
        return static_cast<real>(solver->solve(p, random_values<2>(A.cells.extent(), 3)).iterations);
    };
    const auto gain = [&](int n) { return iterations("cg_jacobi", n) / iterations("cg_mic0", n); };
    EXPECT_GT(gain(160) / gain(40), 1.1) << gain(40) << " " << gain(160);
}

}  // namespace methods_tests
