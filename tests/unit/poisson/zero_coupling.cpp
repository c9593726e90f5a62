// Cells coupled to p = 0 besides their faces: (A + diag(z)) p = b by every method that has them.
#include "poisson/zero_coupling.hpp"

#include "problems.hpp"
#include "support/test.hpp"

namespace zero_coupling_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// A closed box with two blocks of gas: face weights of 1000 inside them, z there only.
template <int D>
struct Pockets {
    Operator<D> A;
    Grid<real, D> z;
    explicit Pockets(const Extent<D>& extent, real coupling) : A(random_operator<D>(extent, 5, {.solid = 0.02, .air = 0})), z(extent) {
        const auto is_gas = [&](const Index<D>& I) {
            bool low = true, high = true;
            for (int a = 0; a < D; ++a) low = low && I[a] < extent[a] / 3, high = high && I[a] > 3 * extent[a] / 4;
            return low || high;
        };
        for_each_cell(extent, [&](const Index<D>& I) { z(I) = is_gas(I) && A.cells(I) == Cell::fluid ? coupling : 0; });
        for (int a = 0; a < D; ++a) {
            auto& w = A.weight[static_cast<std::size_t>(a)];
            w = Grid<real, D>(extent + e<D>(a));
            for_each_cell(w.extent(), [&](const Index<D>& I) {
                if (I[a] > 0 && I[a] < extent[a]) w(I) = is_gas(I) && is_gas(I - e<D>(a)) ? 1000 : 1;
            });
        }
    }
};

/// ‖b − A p − z p‖ / ‖b‖ from the definitions.
template <int D>
real residual_of(const Pockets<D>& problem, const Grid<real, D>& p, const Grid<real, D>& b) {
    Grid<real, D> r;
    poisson::residual(problem.A, p, b, r);
    real sum = 0, all = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
        if (problem.A.cells[i] != Cell::fluid) continue;
        const real rest = r[i] - problem.z[i] * p[i];
        sum += rest * rest, all += b[i] * b[i];
    }
    return std::sqrt(sum / all);
}

template <int D>
poisson::Report solve(const Pockets<D>& problem, const std::string& name, Grid<real, D>& p, const Grid<real, D>& b) {
    const auto solver = poisson::make_solver<D>(name, {.tolerance = 1e-9, .max_iterations = 100000});
    poisson::ZeroCoupling<D>* coupling = poisson::zero_coupling(*solver);
    EXPECT_NE(coupling, nullptr) << name;
    coupling->couple_to_zero(&problem.z);
    solver->setup(problem.A);
    return solver->solve(p, b);
}

}  // namespace

// The tolerance, with the rounding of its own computation.
TEST_IN_2D_AND_3D("every method solves (A + diag(z)) p = b, and no component is closed") {
    const auto extent = extent_of<D>(D == 2 ? 24 : 16, D == 2 ? 20 : 12, 10);
    for (const real coupling : {0.03, 30.0}) {
        const Pockets<D> problem(extent, coupling);
        const auto b = random_values<D>(extent, 7);
        for (const std::string name : {"multigrid", "cg", "cg_jacobi", "cg_mic0", "eigen_iccg", "cholmod"}) {
            Grid<real, D> p(extent);
            const poisson::Report report = solve(problem, name, p, b);
            EXPECT_LT(residual_of(problem, p, b), 1.1e-9) << name << " " << coupling;
            EXPECT_EQ(report.components, 0) << name;
        }
    }
}

// Smooth weights take 7 to 12 iterations, and each block of gas has one mode that the coarse levels do not have exactly.
TEST_IN_2D_AND_3D("the multigrid needs at most 25 iterations for any coupling of two blocks") {
    const auto extent = extent_of<D>(D == 2 ? 64 : 32, D == 2 ? 48 : 24, 16);
    for (const real coupling : {1e-4, 0.03, 30.0, 3e4}) {
        const Pockets<D> problem(extent, coupling);
        Grid<real, D> p(extent);
        const auto b = random_values<D>(extent, 7);
        EXPECT_LE(solve(problem, "multigrid", p, b).iterations, 25) << coupling;
        EXPECT_LT(residual_of(problem, p, b), 1.1e-9) << coupling;
    }
}

TEST_IN_2D_AND_3D("every method solves it from any initial guess, and needs no iteration from the solution") {
    const auto extent = extent_of<D>(D == 2 ? 24 : 16, D == 2 ? 20 : 12, 10);
    const Pockets<D> problem(extent, 30.0);
    const auto b = random_values<D>(extent, 7);
    for (const std::string name : {"multigrid", "cg", "cg_jacobi", "cg_mic0", "eigen_iccg"}) {
        auto p = random_values<D>(extent, 9);
        solve(problem, name, p, b);
        EXPECT_LT(residual_of(problem, p, b), 1.1e-9) << name;
        EXPECT_LE(solve(problem, name, p, b).iterations, 1) << name << ": its residual is at the tolerance, up to rounding";
    }
}

TEST("the method of cosine transforms has no such coupling") {
    EXPECT_EQ(poisson::zero_coupling(*poisson::make_solver<2>("dct", {})), nullptr);
}

}  // namespace zero_coupling_tests
