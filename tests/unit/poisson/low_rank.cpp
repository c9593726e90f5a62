// A few columns on top of the matrix: the answer against the true residual, the same bits on any number of threads.
#include "poisson/poisson.hpp"

#include "problems.hpp"
#include "support/test.hpp"

namespace low_rank_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// Blocks of three and six columns that forty fluid cells see, as stiff as `scale`; some cells are seen by two.
template <int D>
poisson::LowRank random_columns(const Operator<D>& A, real scale) {
    poisson::LowRank more;
    const auto values = random_values<D>(A.cells.extent(), 17);
    std::size_t next = 0;
    const auto value = [&] { return values[next++ % values.size()]; };
    for (std::size_t k = 0; k < 5; ++k) {
        const std::size_t columns = k % 2 == 0 ? 3 : 6, begin = more.entries.size();
        for (std::size_t at = A.cells.size() / 2 + 25 * k; more.entries.size() < begin + 40 && at < A.cells.size(); ++at) {
            if (A.cells[at] != Cell::fluid) continue;
            more.entries.push_back({at, {}});
            for (std::size_t l = 0; l < columns; ++l) more.entries.back().u[l] = value();
        }
        poisson::LowRank::Block block{begin, more.entries.size(), {}};
        for (std::size_t l = 0; l < columns; ++l) block.C[l][l] = scale * (1 + value() * value());
        block.C[0][1] = block.C[1][0] = 0.3 * scale;
        more.blocks.push_back(block);
    }
    return more;
}

/// r −= Σ U C Uᵀ p.
template <int D>
void subtract_columns(const poisson::LowRank& more, const Grid<real, D>& p, Grid<real, D>& r) {
    for (const auto& block : more.blocks) {
        poisson::LowRank::Row t{};
        for (std::size_t i = block.begin; i < block.end; ++i)
            for (std::size_t l = 0; l < t.size(); ++l) t[l] += more.entries[i].u[l] * p[more.entries[i].cell];
        const auto y = poisson::times(block.C, t);
        for (std::size_t i = block.begin; i < block.end; ++i) r[more.entries[i].cell] -= poisson::dot(more.entries[i].u, y);
    }
}

template <int D>
real norm_of(const Grid<real, D>& v) {
    real sum = 0;
    for (const real x : v.values()) sum += x * x;
    return std::sqrt(sum);
}

}  // namespace

TEST_IN_2D_AND_3D("with columns on top of the matrix the true residual meets the tolerance, and the right-hand side is as it was") {
    const auto extent = extent_of<D>(D == 2 ? 210 : 43, D == 2 ? 161 : 38, 49);
    const auto A = random_operator<D>(extent, 2, {.solid = 0.01, .air = 0.02});
    for (const real scale : {1e-3, 0.03, 0.3}) {  // of a diagonal of 2 D
        const auto more = random_columns<D>(A, scale);
        Grid<real, D> b(extent), none(extent), first;
        poisson::residual(A, none, random_values<D>(extent, 5), b);  // nothing where there is no fluid
        const auto given = b;
        for (const int count : {1, 2}) {
            set_threads(count);
            const auto solver = poisson::make_solver<D>("multigrid", {.tolerance = 1e-8});
            solver->setup(A);
            Grid<real, D> p = random_values<D>(extent, 7), r(extent);
            ASSERT_NE(solver->solve(p, b, more), nullptr) << scale;
            EXPECT_TRUE(std::equal(b.values().begin(), b.values().end(), given.values().begin())) << scale;
            poisson::residual(A, p, b, r);
            subtract_columns<D>(more, p, r);
            EXPECT_LE(norm_of<D>(r), 1.001e-8 * norm_of<D>(b)) << scale;  // a thousandth for sums in another order
            if (count == 1)
                first = p;
            else
                EXPECT_TRUE(std::equal(p.values().begin(), p.values().end(), first.values().begin())) << scale;
        }
    }
    set_threads(1);
}

TEST_IN_2D_AND_3D("columns that make the matrix many times as hard are given up, and the right-hand side is as it was") {
    const auto extent = extent_of<D>(D == 2 ? 210 : 43, D == 2 ? 161 : 38, 49);
    const auto A = random_operator<D>(extent, 2, {.solid = 0.01, .air = 0.02});
    Grid<real, D> p(extent), b = random_values<D>(extent, 5);
    const auto given = b;
    const auto solver = poisson::make_solver<D>("multigrid", {.tolerance = 1e-8});
    solver->setup(A);
    EXPECT_EQ(solver->solve(p, b, random_columns<D>(A, 1e4)), nullptr);
    EXPECT_TRUE(std::equal(b.values().begin(), b.values().end(), given.values().begin()));
}

TEST_IN_2D_AND_3D("columns on top of a matrix without air, or of a method that knows none, are refused") {
    const auto extent = extent_of<D>(20, 20, 20);
    const auto closed = random_operator<D>(extent, 1, {.solid = 0, .air = 0}),
               open = random_operator<D>(extent, 2, {.solid = 0, .air = 0.1});
    Grid<real, D> p(extent), b = random_values<D>(extent, 3);
    for (const auto& [A, method] : {std::pair{closed, "multigrid"}, std::pair{open, "cg_mic0"}}) {
        const auto solver = poisson::make_solver<D>(method, {});
        solver->setup(A);
        EXPECT_EQ(solver->solve(p, b, random_columns<D>(A, 1)), nullptr) << method;
    }
}

}  // namespace low_rank_tests
