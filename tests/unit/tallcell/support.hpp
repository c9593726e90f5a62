// Liquid of irregular surface over irregular ground, and legal knots of every kind in it.
#pragma once
#include "support/test.hpp"
#include "tallcell/pressure.hpp"

#include <random>
#include <string>

namespace weir::test {

using namespace tallcell;

/// Columns of liquid under a surface that rises and falls from column to column.
template <int D>
struct Basin {
    MacState<D> state;
    Frame<D> frame;
    Grid<real, D> phi;
    Grid<std::uint8_t, D> closed;
    std::mt19937 random{7};

    /// `ground`: rows of solid, at most; `waves`: how far the surface strays from `level` (a part of the height).
    explicit Basin(const Index<D>& n, int ground = 0, real level = 0.8, real waves = 0.1, const Vec<D>& edges = Vec<D>::constant(0.25)) {
        const Extent<D> cells(n);
        const real h = edges[1];
        state.u = MacVelocity<D>(cells, edges, Vec<D>{});
        state.p = Grid<real, D>(cells);
        state.cells = Grid<poisson::Cell, D>(cells);
        state.rho = 1000;
        frame = Frame<D>(state.u, state.sides);
        phi = Grid<real, D>(cells);
        closed = Grid<std::uint8_t, D>(cells);
        for_each_cell(cells, [&](const Index<D>& I) {
            real wave = std::sin(0.7 * I[0] + 0.3), bed = std::cos(0.9 * I[0]);
            if constexpr (D == 3) wave *= std::cos(0.5 * I[2]), bed *= std::sin(0.4 * I[2] + 1);
            const real height = h * cells[1] * (level + waves * wave) + 0.013 * h;
            phi(I) = frame.centre(I)[1] - height;
            closed(I) = I[1] < ground * (0.5 + 0.5 * bed);
        });
    }
    real uniform(real lower, real upper) { return std::uniform_real_distribution<real>(lower, upper)(random); }
    int integer(int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(random); }

    /// A velocity without any order, at rest on sides and in solids.
    void stir() {
        for (int a = 0; a < D; ++a)
            for (std::size_t i = 0; i < state.u[a].size(); ++i) state.u[a][i] = uniform(-1, 1);
        stop_at_walls();
    }
    void stop_at_walls() {
        for (int a = 0; a < D; ++a)
            for_each_cell(state.u[a].extent(), [&](const Index<D>& I) {
                const bool side = I[a] == 0 || I[a] == frame.cells[a];
                if (side || closed(I) || closed(I - e<D>(a))) state.u[a](I) = 0;
            });
    }
};

/// Elements of any length in every column, one regular cell below the surface at least. `longest`: rows to the next knot, at most.
template <int D>
auto any_knots(Basin<D>& basin, int longest) {
    return [&basin, longest](const Layout<D>& layout, const Grid<poisson::Cell, D>& cells, Knots& knots) {
        knots = Knots{};
        knots.start = PlaneStore<int>(nullptr, 0, static_cast<std::size_t>(layout.n[0]), layout.n[1] + 1, 0, 0);
        for (int c = 0; c < layout.columns(); ++c) {
            const auto liquid = [&](int row) {
                Index<D> I = layout.foot(c);
                I[layout.up] = row;
                return row < layout.rows && cells(I) == poisson::Cell::fluid;
            };
            for (int row = 0; row < layout.rows; ++row) {
                if (!liquid(row)) continue;
                int end = row;
                while (liquid(end)) ++end;
                for (; row < end;) {
                    const int length = std::min(basin.integer(1, longest), std::max(1, end - 2 - row));
                    knots.row.push_back(row);
                    knots.length.push_back(row + 1 < end ? length : 0);
                    row += length;
                }
            }
            knots.start[static_cast<std::size_t>(c) + 1] = knots.count();
        }
    };
}

/// P q: the function that q stands for, on cells.
template <int D>
Grid<real, D> interpolated(const Layout<D>& layout, const Knots& knots, const std::vector<real>& q) {
    Grid<real, D> values(layout.cells);
    for (int c = 0; c < layout.columns(); ++c)
        for (int k = knots.start[static_cast<std::size_t>(c)]; k < knots.start[static_cast<std::size_t>(c) + 1]; ++k) {
            const auto i = static_cast<std::size_t>(k);
            for (int j = 0; j < std::max(1, knots.length[i]); ++j) {
                Index<D> I = layout.foot(c);
                I[layout.up] = knots.row[i] + j;
                values(I) = j == 0 ? q[i] : q[i] + (q[i + 1] - q[i]) * j / knots.length[i];
            }
        }
    return values;
}

/// Pᵀ r.
template <int D>
std::vector<real> tested(const Layout<D>& layout, const Knots& knots, const Grid<real, D>& r) {
    std::vector<real> sums(static_cast<std::size_t>(knots.count()));
    for (int c = 0; c < layout.columns(); ++c)
        for (int k = knots.start[static_cast<std::size_t>(c)]; k < knots.start[static_cast<std::size_t>(c) + 1]; ++k) {
            const auto i = static_cast<std::size_t>(k);
            for (int j = 0; j < std::max(1, knots.length[i]); ++j) {
                Index<D> I = layout.foot(c);
                I[layout.up] = knots.row[i] + j;
                const real share = j == 0 ? 0 : static_cast<real>(j) / knots.length[i];
                sums[i] += (1 - share) * r(I);
                if (share > 0) sums[i + 1] += share * r(I);
            }
        }
    return sums;
}

inline real largest(const std::vector<real>& list) {
    real m = 0;
    for (const real x : list) m = std::max(m, std::abs(x));
    return m;
}

}  // namespace weir::test
