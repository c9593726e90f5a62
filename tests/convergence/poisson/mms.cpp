// Manufactured solutions: every method must reproduce the discrete errors of the 5- and 7-point Laplacian to 4 digits, and order 2.00.
//
// The expected errors were computed apart from this code by exact cosine and sine transforms of the discrete equations (cell-centred
// right-hand side, Dirichlet at faces by p_ghost = −p); for single modes they follow from the eigenvalues 4/h² sin²(πkh/2).
#include "poisson/poisson.hpp"
#include "support/test.hpp"

#include <functional>
#include <map>

using namespace weir;

namespace {

real q(real x) { return x * x / 2 - x * x * x / 3; }
real q2(real x) { return 1 - 2 * x; }

/// p and its Laplacian f on the unit square or cube.
struct Solution {
    std::string name;
    int dim;
    bool dirichlet;
    std::function<real(real, real, real)> p, f;
    std::map<int, std::array<real, 2>> expected;  // cells: RMS and largest error
};

const std::vector<Solution>& solutions() {
    static const std::vector<Solution> list = {
        {"N1",
         2,
         false,
         [](real x, real y, real) { return std::cos(pi * x) * std::cos(2 * pi * y); },
         [](real x, real y, real) { return -5 * pi * pi * std::cos(pi * x) * std::cos(2 * pi * y); },
         {{16, {0.00549465746, 0.01072625854}},
          {32, {0.001367477416, 0.002718506768}},
          {64, {0.0003414841969, 0.0006819402789}},
          {128, {8.534700069e-05, 0.0001706297425}}}},
        {"N2",
         2,
         false,
         [](real x, real y, real) { return q(x) * q(y); },
         [](real x, real y, real) { return q2(x) * q(y) + q(x) * q2(y); },
         {{16, {1.233317685e-05, 3.944353722e-05}},
          {32, {3.087971641e-06, 1.028054878e-05}},
          {64, {7.722851628e-07, 2.622907769e-06}},
          {128, {1.930895552e-07, 6.623382767e-07}}}},
        {"D1",
         2,
         true,
         [](real x, real y, real) { return std::sin(pi * x) * std::sin(3 * pi * y); },
         [](real x, real y, real) { return -10 * pi * pi * std::sin(pi * x) * std::sin(3 * pi * y); },
         {{16, {0.01337079761, 0.0264846791}},
          {32, {0.003305384404, 0.006594852478}},
          {64, {0.0008240376256, 0.001647082662}},
          {128, {0.0002058654941, 0.0004116689854}}}},
        {"D2",
         2,
         true,
         [](real x, real y, real) { return x * (1 - x) * y * (1 - y) * std::exp(x); },
         [](real x, real y, real) { return (-(x * x + 3 * x) * y * (1 - y) - 2 * x * (1 - x)) * std::exp(x); },
         {{16, {0.0004464929786, 0.001194882405}},
          {32, {0.00011213696, 0.0003154673761}},
          {64, {2.806688125e-05, 8.092654447e-05}},
          {128, {7.018768948e-06, 2.048630286e-05}}}},
        {"N3",
         3,
         false,
         [](real x, real y, real z) { return std::cos(2 * pi * x) * std::cos(pi * y) * std::cos(3 * pi * z); },
         [](real x, real y, real z) { return -14 * pi * pi * std::cos(2 * pi * x) * std::cos(pi * y) * std::cos(3 * pi * z); },
         {{16, {0.008048000789, 0.02211130359}}, {32, {0.001993809126, 0.00559867672}}, {64, {0.0004973240513, 0.001404104309}}}},
    };
    return list;
}

/// Closed sides, or p = 0 at half a cell's distance beyond them: a face of weight 2.
template <int D>
poisson::Operator<D> unit_box(int n, bool dirichlet) {
    poisson::Operator<D> A;
    A.cells = Grid<poisson::Cell, D>(replicated(Index<D>::constant(n)), poisson::Cell::fluid);
    for (int a = 0; dirichlet && a < D; ++a) {
        auto& w = A.weight[static_cast<std::size_t>(a)];
        w = Grid<real, D>(A.cells.extent() + e<D>(a), 1);
        for_each_cell<D>(w.extent(), [&](const Index<D>& I) { w(I) = I[a] == 0 || I[a] == n ? 2 : 1; });
    }
    return A;
}

struct Errors {
    real rms = 0, largest = 0;
};

template <int D>
Errors solve(const std::string& method, const Solution& s, int n) {
    const auto A = unit_box<D>(n, s.dirichlet);
    const real h = 1.0 / n;
    Grid<real, D> p(A.cells.extent()), b(A.cells.extent()), exact(A.cells.extent());
    for_each_cell<D>(b.extent(), [&](const Index<D>& I) {
        const real x = (I[0] + 0.5) * h, y = (I[1] + 0.5) * h, z = (I[D - 1] + 0.5) * h;
        exact(I) = s.p(x, y, z);
        b(I) = -h * h * s.f(x, y, z);
    });
    if (!s.dirichlet) {
        const real mean = sum_over<D>(exact.extent(), [&](const Index<D>& I) { return exact(I); }) / static_cast<real>(exact.size());
        for (auto& v : exact.values()) v -= mean;
    }
    // 1e-10: times the condition number (2000 at n = 64) a thousandth of the discretisation error, for its fourth digit.
    const auto solver = poisson::make_solver<D>(method, {.tolerance = n > 64 ? 1e-11 : 1e-10, .max_iterations = 200000});
    solver->setup(A);
    solver->solve(p, b);
    Errors errors;
    for (std::size_t i = 0; i < p.size(); ++i) {
        errors.rms += (p[i] - exact[i]) * (p[i] - exact[i]) / static_cast<real>(p.size());
        errors.largest = std::max(errors.largest, std::abs(p[i] - exact[i]));
    }
    errors.rms = std::sqrt(errors.rms);
    return errors;
}

void check(const poisson::Method& of) {
    const std::string& method = of.name;
    for (const Solution& s : solutions()) {
        if (of.whole_box_only && s.dirichlet) continue;
        int most = 128;  // cells a side: what a method can do in a second or so
        if (method == "jacobi" || method == "red_black") most = s.dim == 3 ? 16 : 32;
        if (method == "cholmod" || method == "eigen_iccg") most = s.dim == 3 ? 32 : 64;
        Errors coarser;
        for (const auto& [n, expected] : s.expected) {
            if (n > most) continue;
            const Errors found = s.dim == 2 ? solve<2>(method, s, n) : solve<3>(method, s, n);
            const std::string what = method + ", " + s.name + ", n = " + std::to_string(n);
            EXPECT_NEAR(found.rms / expected[0], 1, 5e-5) << what;  // four digits
            EXPECT_NEAR(found.largest / expected[1], 1, 5e-5) << what;
            if (n > 16) {
                EXPECT_NEAR(std::log2(coarser.rms / found.rms), 2, 0.02) << what;
            }
            coarser = found;
        }
    }
}

}  // namespace

TEST("every pressure method reproduces the discrete errors") {
    set_threads(1);
    for (const poisson::Method& method : poisson::methods())
        if (!method.needs_petsc) check(method);
}
