// Pressure problems for tests: random cells, weights and right-hand sides, all from a seed.
#pragma once
#include "poisson/poisson.hpp"

#include <random>

namespace weir::test {

using poisson::Cell;
using poisson::Operator;

struct Chances {
    real solid = 0.2, air = 0.1;
    bool weights = false;
    real least_weight = 0.01;  // weights are 10^u with u uniform down to this
    real closed_face = 0;      // part of the faces with weight 0
    bool sides = false;        // some domain sides lead to p = 0
};

template <int D>
Operator<D> random_operator(const Extent<D>& extent, unsigned seed, const Chances& chances) {
    std::mt19937 gen(seed);
    std::uniform_real_distribution<real> u(0, 1);
    Operator<D> A;
    A.cells = Grid<Cell, D>(extent, Cell::fluid);
    for (auto& c : A.cells.values()) {
        const real x = u(gen);
        c = x < chances.solid ? Cell::solid : x < chances.solid + chances.air ? Cell::air : Cell::fluid;
    }
    if (!chances.weights) return A;
    for (int a = 0; a < D; ++a) {
        auto& w = A.weight[static_cast<std::size_t>(a)];
        w = Grid<real, D>(extent + e<D>(a));
        Index<D> I{};
        for (std::size_t at = 0; at < w.size(); ++at) {
            w[at] = u(gen) < chances.closed_face ? 0 : std::pow(chances.least_weight, u(gen));
            std::size_t rest = at;
            for (int d = 0; d < D; ++d) {
                I[d] = static_cast<int>(rest % static_cast<std::size_t>(w.extent()[d]));
                rest /= static_cast<std::size_t>(w.extent()[d]);
            }
            const bool side = I[a] == 0 || I[a] == extent[a];
            if (side && !chances.sides) w[at] = 0;
        }
    }
    return A;
}

template <int D>
Grid<real, D> random_values(const Extent<D>& extent, unsigned seed) {
    std::mt19937 gen(seed);
    std::uniform_real_distribution<real> u(-1, 1);
    Grid<real, D> g(extent);
    for (auto& v : g.values()) v = u(gen);
    return g;
}

/// n cells along each axis, all fluid, closed.
template <int D>
Operator<D> box(int n) {
    Operator<D> A;
    A.cells = Grid<Cell, D>(replicated(Index<D>::constant(n)), Cell::fluid);
    return A;
}

template <int D>
Extent<D> extent_of(int nx, int ny, int nz) {
    Extent<D> n;
    n[0] = nx, n[1] = ny;
    if constexpr (D == 3) n[2] = nz;
    return n;
}

template <int D>
real largest_difference(const Grid<real, D>& a, const Grid<real, D>& b) {
    real largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

template <int D>
real largest(const Grid<real, D>& a) {
    real m = 0;
    for (const real v : a.values()) m = std::max(m, std::abs(v));
    return m;
}

}  // namespace weir::test
