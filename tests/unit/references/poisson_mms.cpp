// The manufactured problems satisfy lap p = f and their sides; solved by brute force they give the table's discrete errors.
#include "validation/references/poisson_mms.hpp"

#include "core/error.hpp"
#include "support/test.hpp"
#include "validation/references/table.hpp"

#include <algorithm>

namespace poisson_mms_tests {

using namespace weir;
using namespace weir::validation;

namespace {

const std::filesystem::path table_file = std::filesystem::path(WEIR_SOURCE_DIR) / "cases/poisson_mms/data/poisson_mms_discrete_errors.csv";

/// RMS and largest error of the 5/7-point formula on n^dim cells. Gauss-Seidel with optimal over-relaxation to round-off:
/// slow, plain, and nothing in common with the solvers it judges.
struct Errors {
    real rms = 0, max = 0;
};
Errors solve(const PoissonProblem& problem, int n) {
    const real h = 1.0 / n, omega = 2 / (1 + std::sin(pi / n));
    const int nz = problem.dim == 3 ? n : 1;
    std::vector<real> p(static_cast<std::size_t>(n * n * nz));
    const auto at = [&](int i, int j, int k) -> real& { return p[static_cast<std::size_t>(i + n * (j + n * k))]; };
    const auto x = [&](int i, int j, int k) { return Vec<3>{(i + 0.5) * h, (j + 0.5) * h, nz > 1 ? (k + 0.5) * h : 0}; };
    for (int sweep = 0; sweep < 60 * n; ++sweep)
        for (int k = 0; k < nz; ++k)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    real sum = -h * h * problem.f(x(i, j, k)), diagonal = 0;
                    const auto face = [&](bool open, int I, int J, int K) {
                        if (open)
                            sum += at(I, J, K), diagonal += 1;
                        else if (problem.dirichlet)
                            diagonal += 2;  // p = 0 half a cell away: the ghost cell holds -p
                    };
                    face(i > 0, i - 1, j, k), face(i + 1 < n, i + 1, j, k), face(j > 0, i, j - 1, k), face(j + 1 < n, i, j + 1, k);
                    if (nz > 1) face(k > 0, i, j, k - 1), face(k + 1 < n, i, j, k + 1);
                    at(i, j, k) += omega * (sum / diagonal - at(i, j, k));
                }
    std::vector<real> error;
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) error.push_back(at(i, j, k) - problem.p(x(i, j, k)));
    real mean = 0;
    for (real e : error) mean += problem.dirichlet ? 0 : e / static_cast<real>(error.size());
    Errors result;
    for (real e : error) result.rms += (e - mean) * (e - mean), result.max = std::max(result.max, std::abs(e - mean));
    result.rms = std::sqrt(result.rms / static_cast<real>(error.size()));
    return result;
}

}  // namespace

TEST("each p satisfies lap p = f") {
    const real h = 1e-3;  // fourth-order differences: h^4 times the sixth derivative (3 pi)^6 = 7e5, so 1e-6; round-off 1e-10
    for (const auto& problem : poisson_problems())
        for (const Vec<3> x : {Vec<3>{0.2, 0.3, 0.6}, Vec<3>{0.9, 0.5, 0.1}, Vec<3>{0.51, 0.77, 0.33}}) {
            real laplacian = 0;
            for (int d = 0; d < problem.dim; ++d) {
                const Vec<3> s = h * Vec<3>::unit(d);
                laplacian +=
                    (-problem.p(x + 2 * s) + 16 * problem.p(x + s) - 30 * problem.p(x) + 16 * problem.p(x - s) - problem.p(x - 2 * s)) /
                    (12 * h * h);
            }
            EXPECT_NEAR(laplacian, problem.f(x), 1e-5) << problem.name;
        }
}

TEST("N problems have no gradient through the sides, D problems vanish there") {
    const real h = 1e-6;
    for (const auto& problem : poisson_problems())
        for (int d = 0; d < problem.dim; ++d)
            for (real end : {0.0, 1.0}) {
                Vec<3> x{0.3, 0.4, 0.7};
                x[d] = end;
                const Vec<3> s = h * Vec<3>::unit(d);
                if (problem.dirichlet) {
                    EXPECT_NEAR(problem.p(x), 0, 1e-15) << problem.name;
                } else {
                    EXPECT_NEAR((problem.p(x + s) - problem.p(x - s)) / (2 * h), 0, 1e-9) << problem.name;
                }
            }
}

TEST("the 5/7-point formula solved by over-relaxation gives the discrete errors of the table to six digits") {
    const Table table = read_table(table_file);
    int compared = 0;
    for (const auto& problem : poisson_problems())
        for (int n : problem.dim == 2 ? std::vector<int>{16, 32} : std::vector<int>{16}) {
            const Table row = table.where("case", problem.table).where("N", std::to_string(n));
            ASSERT_EQ(row.rows.size(), 1u);
            const Errors errors = solve(problem, n);
            EXPECT_NEAR(errors.rms / row.number(0, "rms_error"), 1, 1e-6) << problem.name << " " << n;
            EXPECT_NEAR(errors.max / row.number(0, "max_error"), 1, 1e-6) << problem.name << " " << n;
            ++compared;
        }
    EXPECT_EQ(compared, 9);
}

TEST("an unknown problem is refused with the list of known ones") { EXPECT_THROW(poisson_problem("N4"), BadInput); }

}  // namespace poisson_mms_tests
