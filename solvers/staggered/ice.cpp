#include "staggered/ice.hpp"

#include "staggered/rows.hpp"

#include <algorithm>

namespace weir::staggered {

namespace {

constexpr real smallest_liquid = 1e-3;  // ε: of the same size as in Voller & Prakash 1987; the drag of pure ice is C/ε
constexpr real least_mobility = 1e-3;   // less is none: the pressure's matrix knows no weaker face

}  // namespace

template <int D>
void hold_back(MacState<D>& s, const Grid<real, D>& liquid, real k) {
    for (int a = 0; a < D; ++a) {
        auto &beta = s.mobility[static_cast<std::size_t>(a)], &u = s.u[a];
        if (beta.empty()) beta = Grid<real, D>(u.extent(), 1);
        const int n = s.extent()[a];
        const bool joins = s.sides.periodic(a);
        for_each_row(Index<D>{}, u.extent(), [&](const Index<D>& first, int count) {
            real *to = &beta(first), *speed = &u(first);
            const auto face = [&](int i, real below, real above) {
                const real f = std::min(below, above), ice = 1 - f;
                const real b = 1 / (1 + k * ice * ice / (f * f * f + smallest_liquid));
                to[i] = b < least_mobility ? 0 : b;
                speed[i] *= to[i];
            };
            Index<D> below = first - e<D>(a), above = first;
            if (a > 0) {
                if (first[a] == 0) below[a] = joins ? n - 1 : 0;
                if (first[a] == n) above[a] = joins ? 0 : n - 1;
                const real *f = &liquid(above), *g = &liquid(below);
#pragma omp simd
                for (int i = 0; i < count; ++i) face(i, g[i], f[i]);
                return;
            }
            const auto outer = [&](int i) {  // the first and the last face of the line have a cell on one side alone
                Index<D> low = below, high = above;
                low[0] += i, high[0] += i;
                if (high[0] == n) high[0] = joins ? 0 : n - 1;
                if (low[0] < 0) low[0] = joins ? n - 1 : 0;
                face(i, liquid(low), liquid(high));
            };
            int begin = 0, end = count;
            if (first[0] == 0) outer(begin++);
            if (first[0] + count > n) outer(--end);
            if (begin >= end) return;
            above[0] += begin;
            const real* f = &liquid(above) - begin;
#pragma omp simd
            for (int i = begin; i < end; ++i) face(i, f[i - 1], f[i]);
        });
    }
}

template void hold_back(MacState<2>&, const Grid<real, 2>&, real);
template void hold_back(MacState<3>&, const Grid<real, 3>&, real);

}  // namespace weir::staggered
