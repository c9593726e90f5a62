// What the multigrid promises beyond the right answer: a symmetric preconditioner, the same bits on any number of threads, no allocation.
#include "poisson/poisson.hpp"

#include "poisson/geometric/geometric_cg.hpp"
#include "problems.hpp"
#include "support/count_allocations.hpp"
#include "support/test.hpp"

namespace multigrid_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// Large enough for several threads (levels of 20,000 cells and more), of no round size.
template <int D>
Extent<D> large() {
    return extent_of<D>(D == 2 ? 210 : 43, D == 2 ? 161 : 38, 49);
}

template <int D>
std::vector<Operator<D>> varied(const Extent<D>& extent) {
    std::vector<Operator<D>> list;
    list.push_back(random_operator<D>(extent, 1, {.solid = 0, .air = 0}));
    list.push_back(random_operator<D>(extent, 2, {.solid = 0.05, .air = 0.02}));
    list.push_back(random_operator<D>(extent, 3, {.solid = 0.02, .air = 0, .weights = true, .least_weight = 0.3, .sides = true}));
    list.push_back(random_operator<D>(extent, 4, {.solid = 0, .air = 0.01}));
    list.back().axis_weight[0] = 6;
    list.push_back(random_operator<D>(extent, 5, {.solid = 0.1, .air = 0}));
    if (extent[D - 1] % 2 == 0) list.back().periodic[D - 1] = true;
    if (extent[0] % 2 == 0) list.back().periodic[0] = true;
    return list;
}

template <int D>
real inner(const Grid<real, D>& a, const Grid<real, D>& b) {
    real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

TEST_IN_2D_AND_3D("the V-cycle is symmetric and positive definite: x.My = y.Mx, x.Mx > 0") {
    for (const auto& extent : {extent_of<D>(36, 27, 14), extent_of<D>(32, 24, 12), extent_of<D>(361, 1, 13)}) {
        int number = 0;
        for (const auto& A : varied<D>(extent)) {
            poisson::Natural<D> problem;
            problem.build(A, {});
            poisson::GeometricCg<D> cg;
            if (!cg.setup(problem)) continue;
            // Air, solids and closed components carry no residual.
            const auto in_range = [&](unsigned seed) {
                Grid<real, D> r, none(extent);
                poisson::residual(A, none, random_values<D>(extent, seed), r);
                if (problem.closed() > 0) {
                    auto x = random_values<D>(extent, seed);
                    for (std::size_t i = 0; i < x.size(); ++i) x[i] = A.cells[i] == Cell::fluid ? x[i] : 0;
                    poisson::residual(A, x, none, r);
                }
                return r;
            };
            const auto x = in_range(8), y = in_range(9);
            Grid<real, D> Mx(extent), My(extent);
            cg.precondition(problem, x, Mx);
            cg.precondition(problem, y, My);
            const real xMx = inner(x, Mx), yMy = inner(y, My);
            EXPECT_GT(xMx, 0) << number;
            EXPECT_GT(yMy, 0) << number;
            // Single precision: 6e-8 times some hundred operations.
            EXPECT_NEAR(inner(x, My), inner(y, Mx), 2e-5 * std::sqrt(xMx * yMy)) << number;
            ++number;
        }
        EXPECT_GE(number, 3);
    }
}

// Entry n of a periodic axis is ignored (poisson.hpp): the result has the same bits for any value of it.
TEST_IN_2D_AND_3D("every method ignores the second copy of a periodic axis's first face") {
    const auto extent = extent_of<D>(40, D == 2 ? 36 : 20, 16);
    auto A = random_operator<D>(extent, 6, {.solid = 0.02, .air = 0.02, .weights = true, .least_weight = 0.3, .sides = true});
    for (const int a : {0, 1, D - 1}) A.periodic[static_cast<std::size_t>(a)] = true;
    auto alike = A;
    for (int a = 0; a < D; ++a) {
        auto& w = alike.weight[static_cast<std::size_t>(a)];
        Index<D> lo{};
        const Extent<D> hi = w.extent();
        lo[a] = extent[a];
        for_each_in(lo, hi, [&](Index<D> I) {
            const Index<D> last = I;
            I[a] = 0;
            w(last) = w(I);
        });
    }
    const auto b = random_values<D>(extent, 22);
    for (const std::string name : {"multigrid", "cg", "red_black", "jacobi"}) {
        const auto solve = [&](const Operator<D>& problem, int& iterations) {
            const auto solver = poisson::make_solver<D>(name, {.tolerance = 1e-8, .max_iterations = 10000});
            solver->setup(problem);
            Grid<real, D> p(extent);
            iterations = solver->solve(p, b).iterations;
            return p;
        };
        int once = 0, twice = 0;
        EXPECT_EQ(largest_difference(solve(A, once), solve(alike, twice)), 0) << name;
        EXPECT_EQ(once, twice) << name;
    }
}

TEST_IN_2D_AND_3D("every method gives the same bits on 1, 2 and 3 threads") {
    for (const auto& A : varied<D>(large<D>())) {
        const auto b = random_values<D>(A.cells.extent(), 21);
        for (const std::string name : {"multigrid", "cg", "cg_jacobi", "cg_mic0", "red_black", "jacobi"}) {
            const auto solve = [&](int count) {
                set_threads(count);
                const bool all = name == "multigrid";
                const auto solver =
                    poisson::make_solver<D>(name, {.tolerance = 1e-9, .max_iterations = all ? 200 : 15, .fixed_iterations = !all});
                solver->setup(A);
                Grid<real, D> p(A.cells.extent());
                solver->solve(p, b);
                return p;
            };
            const auto one = solve(1);
            for (const int count : {2, 3}) {
                const auto many = solve(count);
                EXPECT_TRUE(std::equal(one.values().begin(), one.values().end(), many.values().begin()))
                    << name << " on " << count << " threads";
            }
        }
    }
    set_threads(1);
}

TEST("the same bits on 1, 2 and 3 threads where each closes the triangles at its slab's beginning alone: hundreds of planes") {
    for (const auto& A : varied<2>(extent_of<2>(90, 404, 1))) {
        const auto b = random_values<2>(A.cells.extent(), 22);
        const auto solve = [&](int count) {
            set_threads(count);
            const auto solver = poisson::make_solver<2>("multigrid", {.tolerance = 1e-9, .max_iterations = 200});
            solver->setup(A);
            Grid<real, 2> p(A.cells.extent());
            solver->solve(p, b);
            return p;
        };
        const auto one = solve(1);
        for (const int count : {2, 3}) {
            const auto many = solve(count);
            EXPECT_TRUE(std::equal(one.values().begin(), one.values().end(), many.values().begin())) << count << " threads";
        }
    }
    set_threads(1);
}

TEST_IN_2D_AND_3D("the second solve allocates nothing") {
    set_threads(1);
    const auto A = random_operator<D>(large<D>(), 3, {.solid = 0.02, .air = 0.01});
    const auto walls = random_operator<D>(large<D>(), 3, {.solid = 0.35, .air = 0});  // takes the algebraic cycle
    const auto b = random_values<D>(A.cells.extent(), 5);
    for (const auto* op : {&A, &walls})
        for (const std::string name : {"multigrid", "cg_mic0", "cg_jacobi", "cg", "red_black", "jacobi"}) {
            const bool all = name == "multigrid";
            const auto solver = poisson::make_solver<D>(name, {.max_iterations = all ? 200 : 5, .fixed_iterations = !all});
            solver->setup(*op);
            Grid<real, D> p(b.extent());
            solver->solve(p, b);
            p.fill(0);
            const long before = allocations;
            solver->solve(p, b);
            EXPECT_EQ(allocations - before, 0) << name;
        }
}

TEST_IN_2D_AND_3D("a second setup with other cells leaves nothing of the first") {
    const auto extent = large<D>();
    const auto first = random_operator<D>(extent, 1, {.solid = 0, .air = 0});
    const auto second = random_operator<D>(extent, 2, {.solid = 0.3, .air = 0.3});
    const auto b = random_values<D>(extent, 3);
    const auto used = poisson::make_solver<D>("multigrid", {}), fresh = poisson::make_solver<D>("multigrid", {});
    Grid<real, D> p(extent), q(extent);
    used->setup(first);
    used->solve(p, b);
    p.fill(0);
    used->setup(second);
    used->solve(p, b);
    fresh->setup(second);
    fresh->solve(q, b);
    EXPECT_TRUE(std::equal(p.values().begin(), p.values().end(), q.values().begin()));
}

TEST_IN_2D_AND_3D("a guess that is the answer takes no iteration, and a near one fewer") {
    const auto A = random_operator<D>(large<D>(), 3, {.solid = 0.02, .air = 0.01});
    const auto b = random_values<D>(A.cells.extent(), 5);
    const auto solver = poisson::make_solver<D>("multigrid", {});
    solver->setup(A);
    Grid<real, D> p(b.extent());
    const int cold = solver->solve(p, b).iterations;
    EXPECT_EQ(solver->solve(p, b).iterations, 0);
    for (std::size_t i = 0; i < p.size(); ++i) p[i] *= 1 + 1e-4;
    EXPECT_LT(solver->solve(p, b).iterations, cold);
}

}  // namespace multigrid_tests
