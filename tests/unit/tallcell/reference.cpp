// The fast pressure against a plain one: the lattice's matrix and the functions of the knots as dense tables, and Gauss's elimination, all
// in double precision and written down as the definitions stand.
#include "support.hpp"

namespace weir::test::reference_tests {
namespace {

using Dense = std::vector<std::vector<real>>;

Dense zeros(std::size_t rows, std::size_t columns) { return Dense(rows, std::vector<real>(columns, 0.0)); }

/// x of A x = b for a symmetric positive A.
std::vector<real> solve(Dense A, std::vector<real> b) {
    const std::size_t n = b.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            const real factor = A[j][i] / A[i][i];
            if (factor == 0) continue;
            for (std::size_t k = i; k < n; ++k) A[j][k] -= factor * A[i][k];
            b[j] -= factor * b[i];
        }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= A[i][k] * b[k];
        b[i] /= A[i][i];
    }
    return b;
}

/// P, A = Pᵀ A_f P and b = Pᵀ (−∇·u) of a basin and the knots in it.
template <int D>
struct Plain {
    Dense P, A;
    std::vector<real> b;

    Plain(const Basin<D>& basin, const TallPressure<D>& tall) {
        const Knots& knots = tall.knots();
        const auto count = static_cast<std::size_t>(knots.count());
        const Frame<D>& frame = basin.frame;
        std::vector<std::vector<std::size_t>> hats;  // of a cell: the knots whose functions are not zero there
        P = zeros(product(frame.cells), count);
        for (std::size_t j = 0; j < count; ++j) {
            std::vector<real> unit(count);
            unit[j] = 1;
            const Grid<real, D> values = interpolated(tall.layout(), knots, unit);
            for (std::size_t i = 0; i < values.size(); ++i) P[i][j] = values[i];
        }
        hats.resize(P.size());
        for (std::size_t i = 0; i < P.size(); ++i)
            for (std::size_t j = 0; j < count; ++j)
                if (P[i][j] != 0) hats[i].push_back(j);
        A = zeros(count, count);
        const auto& cells = basin.state.cells;
        const auto add = [&](std::size_t i, std::size_t j, real value) {
            for (const std::size_t K : hats[i])
                for (const std::size_t L : hats[j]) A[K][L] += P[i][K] * value * P[j][L];
        };
        Grid<real, D> inflow(frame.cells);
        for (std::size_t own = 0; own < cells.size(); ++own) {  // one after the other: cells of one column add to the same entries
            const Index<D> I = index_of<D>(frame.cells, own);
            if (cells(I) != poisson::Cell::fluid) continue;
            for (int a = 0; a < D; ++a) {
                const real k = 1 / (frame.h[a] * frame.h[a]);
                inflow(I) += (basin.state.u[a](I) - basin.state.u[a](I + e<D>(a))) / frame.h[a];
                for (const int by : {-1, 1}) {
                    Index<D> J = I;
                    if (!frame.step(J, a, by) || J == I) continue;
                    if (cells(J) == poisson::Cell::fluid) add(own, own, k), add(own, cells.linear(J), -k);
                    if (cells(J) == poisson::Cell::air) add(own, own, k * std::min(1 - basin.phi(J) / basin.phi(I), 1 + 1 / thinnest));
                }
            }
        }
        b.assign(count, 0);
        for (std::size_t i = 0; i < P.size(); ++i)
            for (const std::size_t K : hats[i]) b[K] += P[i][K] * inflow[i];
    }
};

template <int D>
Basin<D> small_basin(bool around, bool odd) {
    Index<D> cells;
    cells.fill(odd ? 5 : 6);
    cells[1] = 18;
    if constexpr (D == 3) cells[2] = odd ? 3 : 4;
    Basin<D> basin(cells, 3, 0.75, 0.1);
    if (around) {
        for (int a = 0; a < D; ++a)
            for (const int end : {0, 1})
                if (a != 1) basin.state.sides.side(a, end).kind = geometry::SideKind::periodic;
        basin.frame = Frame<D>(basin.state.u, basin.state.sides);
    }
    return basin;
}

template <int D>
void stir(Basin<D>& basin) {
    for (int a = 0; a < D; ++a) {
        for (real& u : basin.state.u[a].values()) u = basin.uniform(-1, 1);
        for_each_cell(basin.state.u[a].extent(), [&](const Index<D>& I) {
            if (I[a] != basin.frame.cells[a]) {
                const Index<D> below = basin.frame.near(I, a, -1);
                const bool wall = I[a] == 0 && !basin.frame.periodic(a);
                if (wall || basin.closed(I) || basin.closed(below)) basin.state.u[a](I) = 0;
            } else if (!basin.frame.periodic(a)) {
                basin.state.u[a](I) = 0;
            }
        });
    }
    sync_periodic(basin.state.u, basin.state.sides);
}

TEST_IN_2D_AND_3D("matrix, projection and pressure are what plain elimination makes of the definitions") {
    for (const bool around : {false, true})
        for (const bool odd : {false, true})
            for (const int longest : {1, 2, 4, 20}) {
                Basin<D> basin = small_basin<D>(around, odd);
                TallPressure<D> tall(basin.frame, 1, {.tolerance = 1e-14});
                tall.set_surface(basin.phi, basin.closed, basin.state, any_knots(basin, longest));
                stir(basin);
                tall.restrict_velocity(basin.state);
                const Plain<D> plain(basin, tall);
                const std::size_t n = plain.b.size();

                // Round-off: 2^-53 of the largest entry, 1/theta = 51 times that between two cells, times the some forty terms of a row.
                const real k = 1 / (basin.frame.h[0] * basin.frame.h[0]), tiny = 40 * 51 * k * 1.2e-16 * 4;
                std::vector<real> q(n), Aq(n), b(n);
                for (real& x : q) x = basin.uniform(-1, 1);
                tall.multiply(q, Aq);
                for (std::size_t i = 0; i < n; ++i) {
                    real sum = 0;
                    for (std::size_t j = 0; j < n; ++j) sum += plain.A[i][j] * q[j];
                    ASSERT_NEAR(Aq[i], sum, tiny) << "A, longest " << longest << " around " << around << " odd " << odd;
                }
                tall.weak_divergence(basin.state, b);
                for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(b[i], plain.b[i], 1e-12 * std::sqrt(k) * 20) << "b, longest " << longest;

                // The error of q: tolerance or round-off, 1e-14 of b, over the least eigenvalue of A, which is that of a column of 14 cells
                // under air, (pi / 28)^2 k = 0.0126 k; the velocity's is 2 / h of that.
                const std::vector<real> solution = solve(plain.A, plain.b);
                const MacVelocity<D> before = basin.state.u;
                tall.project(basin.phi, basin.state, 1000);  // dt = rho: q is p itself
                const real largest_b = largest(plain.b) * std::sqrt(static_cast<real>(n)), error = 1e-13 * largest_b / (0.0126 * k);
                for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(tall.potential()[i], solution[i], error) << "q, longest " << longest;

                // Faces between columns lose the gradient of P q, where the knots leave them to themselves.
                tall.spread(basin.state, 1000);
                if (longest > 1) continue;
                const Grid<real, D> p = interpolated(tall.layout(), tall.knots(), solution);
                for (int a = 0; a < D; ++a)
                    for_each_cell(basin.frame.cells, [&](const Index<D>& I) {
                        Index<D> J = I;
                        if (!basin.frame.step(J, a, -1) || basin.state.cells(I) != poisson::Cell::fluid ||
                            basin.state.cells(J) != poisson::Cell::fluid)
                            return;
                        const real expected = before[a](I) - (p(I) - p(J)) / basin.frame.h[a];
                        ASSERT_NEAR(basin.state.u[a](I), expected, 2 * error / basin.frame.h[a]) << "u, longest " << longest;
                    });
            }
}

}  // namespace
}  // namespace weir::test::reference_tests
