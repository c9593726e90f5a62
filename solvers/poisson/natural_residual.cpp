// The true residual of a row, in the caller's order and in double precision.
#include "poisson/natural.hpp"

#include <cstring>

namespace weir::poisson {

namespace {

/// p of the calling thread's row with what lies beyond its ends.
const real* with_margins(const real* p, int n, bool ring) {
    thread_local std::vector<real> copy;
    if (copy.size() < static_cast<std::size_t>(n) + 2) copy.resize(static_cast<std::size_t>(n) + 2);
    std::memcpy(copy.data() + 1, p, static_cast<std::size_t>(n) * sizeof(real));
    copy[0] = ring ? p[n - 1] : 0;
    copy[static_cast<std::size_t>(n) + 1] = ring ? p[0] : 0;
    return copy.data() + 1;
}

const real* zeros(int n) {
    thread_local std::vector<real> row;
    if (row.size() < static_cast<std::size_t>(n)) row.assign(static_cast<std::size_t>(n), 0);
    return row.data();
}

}  // namespace

template <int D>
void Natural<D>::residual_row(int q, int j, const real* p, const real* b, real* r) const {
    const int nx = n_[0], here = row(q, j);
    const std::ptrdiff_t own = static_cast<std::ptrdiff_t>(here) * nx;
    const real* centre = with_margins(p + own, nx, periodic_[0]);
    std::array<const real*, 2 * (D - 1)> other, weight{};
    std::array<const std::uint8_t*, 2 * (D - 1)> kind;
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
            const auto k = static_cast<std::size_t>(2 * (a - 1) + side);
            const int beside = neighbour(q, j, a, side);
            other[k] = beside < 0 ? zeros(nx) : p + static_cast<std::ptrdiff_t>(beside) * nx;
            kind[k] = cells(beside);
            if (weighted_) weight[k] = faces(a, q + (a == D - 1 ? side : 0), j + (a == D - 1 ? 0 : side));
        }
    const std::uint8_t* c = cells(here);
    const real* wx = weighted_ ? faces(0, q, j) : nullptr;
    const Vec<D> w = axis_weight_;
    constexpr auto closed_cell = static_cast<std::uint8_t>(Cell::solid);
    std::fill(r, r + nx, 0.0);
    for (const Run* run = runs_begin(here); run != runs_end(here); ++run) {
        const real m = mean(*run);
        if (weighted_) {
#pragma omp simd
            for (int i = run->begin; i < run->end; ++i) {
                real Ap = wx[i] * (centre[i] - centre[i - 1]) + wx[i + 1] * (centre[i] - centre[i + 1]);
                for (std::size_t k = 0; k < 2 * (D - 1); ++k) Ap += weight[k][i] * (centre[i] - other[k][i]);
                r[i] = b[own + i] - m - Ap;
            }
        } else {
#pragma omp simd
            for (int i = run->begin; i < run->end; ++i) {
                real Ap = w[0] * ((c[i - 1] != closed_cell ? centre[i] - centre[i - 1] : 0) +
                                  (c[i + 1] != closed_cell ? centre[i] - centre[i + 1] : 0));
                for (std::size_t k = 0; k < 2 * (D - 1); ++k)
                    Ap += w[static_cast<int>(1 + k / 2)] * (kind[k][i] != closed_cell ? centre[i] - other[k][i] : 0);
                r[i] = b[own + i] - m - Ap;
            }
        }
    }
}

template void Natural<2>::residual_row(int, int, const real*, const real*, real*) const;
template void Natural<3>::residual_row(int, int, const real*, const real*, real*) const;

}  // namespace weir::poisson
