// The true residual of a row, in the caller's order and in double precision.
#include "poisson/geometric/natural.hpp"

#include <cstring>

namespace weir::poisson {

namespace {

/// p of a row in the thread's buffer, with the values beyond its ends.
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
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
            const auto k = static_cast<std::size_t>(2 * (a - 1) + side);
            const int beside = neighbour(q, j, a, side);
            other[k] = beside < 0 ? zeros(nx) : p + static_cast<std::ptrdiff_t>(beside) * nx;
            if (weighted_) weight[k] = faces(a, q + (a == D - 1 ? side : 0), j + (a == D - 1 ? 0 : side));
        }
    const real* wx = weighted_ ? faces(0, q, j) : nullptr;
    std::fill(r, r + nx, 0.0);
    for (const Run* run = runs_begin(here); run != runs_end(here); ++run) {
        const real m = mean(*run);
        const real* z = zero(here);
        if (weighted_) {
#pragma omp simd
            for (int i = run->begin; i < run->end; ++i) {
                real Ap = wx[i] * (centre[i] - centre[i - 1]) + wx[i + 1] * (centre[i] - centre[i + 1]);
                for (std::size_t k = 0; k < 2 * (D - 1); ++k) Ap += weight[k][i] * (centre[i] - other[k][i]);
                r[i] = b[own + i] - m - Ap;
            }
            for (int i = run->begin; z && i < run->end; ++i) r[i] -= z[i] * centre[i];
        } else {
            const std::uint8_t* count = count_.data() + own;
            std::array<const real*, 2 * (D - 1)> o = other;
            const real w0 = axis_weight_[0];
#pragma omp simd
            for (int i = run->begin; i < run->end; ++i) {
                real beside = centre[i - 1] + centre[i + 1];
                for (std::size_t k = 0; k < 2 * (D - 1); ++k) beside += o[k][i];
                r[i] = b[own + i] - m - w0 * (count[i] * centre[i] - beside);
            }
        }
    }
}

template <int D>
void Natural<D>::rhs_row(int row, const real* b, real* r) const {
    const std::ptrdiff_t own = static_cast<std::ptrdiff_t>(row) * n_[0];
    std::fill(r, r + n_[0], 0.0);
    for (const Run* run = runs_begin(row); run != runs_end(row); ++run) {
        const real m = mean(*run);
        for (int i = run->begin; i < run->end; ++i) r[i] = b[own + i] - m;
    }
}

template <int D>
void Natural<D>::sum_row(int row, const real* values) const {
    if (closed_ == 0) return;
    for (const Run* run = runs_begin(row); run != runs_end(row); ++run) {
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int i = run->begin; i < run->end; ++i) sum += values[i];
        sum_[static_cast<std::size_t>(run - runs_.data())] = sum;
    }
}

template <int D>
void Natural<D>::means_from_sums() const {
    clear_means();
    if (closed_ == 0) return;
    component_sum_.assign(mean_.size(), ExactSum{});
    const auto first = static_cast<std::size_t>(run_start_[static_cast<std::size_t>(planes_.begin * rows_in_plane())]);
    const auto last = static_cast<std::size_t>(run_start_[static_cast<std::size_t>(planes_.end * rows_in_plane())]);
    for (std::size_t k = first; k < last; ++k)
        if (runs_[k].component >= 0) component_sum_[static_cast<std::size_t>(runs_[k].component)].add(sum_[k]);
    sums_of_ranks(own_, component_sum_);
    for (std::size_t c = 0; c < mean_.size(); ++c) mean_[c] = component_sum_[c].value() / size_[c];
}

template <int D>
void Natural<D>::find_means(const Grid<real, D>& values) const {
    if (closed_ == 0) return;
    for_each_row_of_own([&](int row) { sum_row(row, values.data() + static_cast<std::ptrdiff_t>(row) * n_[0]); });
    means_from_sums();
}

template <int D>
void Natural<D>::subtract_means(Grid<real, D>& p) const {
    if (closed_ == 0) return;
    for_each_row_of_own([&](int row) {
        real* v = p.data() + static_cast<std::ptrdiff_t>(row) * n_[0];
        for (const Run* run = runs_begin(row); run != runs_end(row); ++run) {
            const real m = mean(*run);
            for (int i = run->begin; i < run->end; ++i) v[i] -= m;
        }
    });
}

template <int D>
real Natural<D>::norm(const Grid<real, D>& b) const {
    return std::sqrt(plane_sum(own_, planes(), [&](int q) {
        real sum = 0;
        for (int row = q * rows_in_plane(); row < (q + 1) * rows_in_plane(); ++row) {
            const real* v = b.data() + static_cast<std::ptrdiff_t>(row) * n_[0];
            for (const Run* run = runs_begin(row); run != runs_end(row); ++run) {
                const real m = mean(*run);
                real part = 0;
#pragma omp simd reduction(+ : part)
                for (int i = run->begin; i < run->end; ++i) part += (v[i] - m) * (v[i] - m);
                sum += part;
            }
        }
        return sum;
    }));
}

template <int D>
void Natural<D>::clear_outside(int row, real* values) const {
    int from = 0;
    for (const Run* run = runs_begin(row); run != runs_end(row); ++run) {
        if (run->begin > from) std::fill(values + from, values + run->begin, 0.0);
        from = run->end;
    }
    std::fill(values + from, values + n_[0], 0.0);
}

template <int D>
bool Natural<D>::clean(Grid<real, D>& p) const {
    const real nonzero = plane_sum(own_, planes(), [&](int q) {
        int found = 0;
        for (int row = q * rows_in_plane(); row < (q + 1) * rows_in_plane(); ++row) {
            real* v = p.data() + static_cast<std::ptrdiff_t>(row) * n_[0];
            clear_outside(row, v);
            for (int i = 0; i < n_[0]; ++i) found |= v[i] != 0;
        }
        return real(found);
    });
    return nonzero == 0;
}

template class Natural<2>;
template class Natural<3>;

}  // namespace weir::poisson
