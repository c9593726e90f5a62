#include "mac/heat/ice.hpp"

#include "mac/grid/rows.hpp"

#include <algorithm>

namespace weir::mac {

namespace {

constexpr real smallest_liquid = 1e-3;  // ε: as large as in Voller & Prakash 1987; the drag of pure ice is C/ε
constexpr real least_mobility = 1e-3;   // smaller values are set to zero: the pressure matrix has no weaker face

/// β of a face and the reduced velocity there, from the liquid fraction of the cells on both sides.
struct Face {
    real k;
    void operator()(real below, real above, real& beta, real& u) const {
        const real f = std::min(below, above), ice = 1 - f;
        const real b = 1 / (1 + k * ice * ice / (f * f * f + smallest_liquid));
        beta = b < least_mobility ? 0 : b;
        u *= beta;
    }
};

/// The faces of a row of cells along that row.
template <int D>
void apply_drag_along(MacState<D>& s, const Grid<real, D>& liquid, const Index<D>& row, const Face& face) {
    const int n = s.extent()[0];
    const bool joins = s.sides.periodic(0);
    const real* f = &liquid(row);
    real *beta = &s.mobility[0](row), *u = &s.u[0](row);
    face(f[joins ? n - 1 : 0], f[0], beta[0], u[0]);
#pragma omp simd
    for (int i = 1; i < n; ++i) face(f[i - 1], f[i], beta[i], u[i]);
    face(f[n - 1], f[joins ? 0 : n - 1], beta[n], u[n]);
}

}  // namespace

template <int D>
void Ice<D>::find_ranges(const Grid<real, D>& liquid) {
    if (ranges_.empty()) ranges_ = Grid<Range, D>(rows_of(liquid.extent()));
    for_each_cell(ranges_.extent(), [&](const Index<D>& row) {
        const real* f = &liquid(row);
        real least = infinity, most = -infinity;
#pragma omp simd reduction(min : least) reduction(max : most)
        for (int i = 0; i < liquid.extent()[0]; ++i) least = std::min(least, f[i]), most = std::max(most, f[i]);
        ranges_(row) = {least, most};
    });
}

/// Rows of faces entirely in melt, or entirely in ice, have one β.
template <int D>
void Ice<D>::apply_drag(MacState<D>& s, const Grid<real, D>& liquid, real k) {
    const Face face{k};
    find_ranges(liquid);
    for (int a = 0; a < D; ++a) {
        auto &mobility = s.mobility[static_cast<std::size_t>(a)], &velocity = s.u[a], &even = even_[static_cast<std::size_t>(a)];
        const int n = s.extent()[a], count = velocity.extent()[0];
        const bool joins = s.sides.periodic(a);
        if (mobility.empty()) mobility = Grid<real, D>(velocity.extent(), 1);
        if (even.empty()) even = Grid<real, D>(rows_of(velocity.extent()), -1);
        for_each_cell(even.extent(), [&](const Index<D>& row) {
            Index<D> below = row, above = row;
            if (a > 0) {
                below[a] = row[a] > 0 ? row[a] - 1 : joins ? n - 1 : 0;
                above[a] = row[a] < n ? row[a] : joins ? 0 : n - 1;
            }
            real *beta = &mobility(row), *u = &velocity(row);
            const Range low = ranges_(below), high = ranges_(above);
            const bool melt = low.least == 1 && high.least == 1;
            if (melt || low.most == 0 || high.most == 0) {
                real all = 0, one = 1;
                face(melt, melt, all, one);
                if (even(row) != all) std::fill_n(beta, count, all);
                if (all < 1)
                    for (int i = 0; i < count; ++i) u[i] *= all;
                even(row) = all;
                return;
            }
            even(row) = -1;
            if (a == 0) return apply_drag_along(s, liquid, row, face);
            const real *f = &liquid(above), *g = &liquid(below);
#pragma omp simd
            for (int i = 0; i < count; ++i) face(g[i], f[i], beta[i], u[i]);
        });
    }
}

template <int D>
std::size_t Ice<D>::bytes() const {
    std::size_t total = ranges_.size() * sizeof(Range);
    for (const auto& even : even_) total += even.size() * sizeof(real);
    return total;
}

template class Ice<2>;
template class Ice<3>;

}  // namespace weir::mac
