#include "two_phase/planes.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

namespace {

/// Components in ascending order; in 2D the first is 0.
using Sorted = std::array<real, 3>;

/// Makes the components of m positive by reflections of the cell. Returns the change of alpha.
template <int D>
real reflect(Vec<D>& m) {
    real shift = 0;
    for (int d = 0; d < D; ++d) {
        if (m[d] >= 0) continue;
        shift -= m[d];
        m[d] = -m[d];
    }
    return shift;
}

template <int D>
Sorted sorted(const Vec<D>& m) {
    const auto [low, high] = std::minmax(m[D - 2], m[D - 1]);
    if constexpr (D == 2) return {0, low, high};
    return {std::min(m[0], low), std::max(low, std::min(m[0], high)), std::max(m[0], high)};
}

/// (x³ − (x − m1)³)/m1 for the positive parts: the cubes of inclusion and exclusion of corners, divided by m1 without cancellation.
real difference_of_cubes(real x, real m1) {
    if (x <= 0) return 0;
    return x < m1 ? x * x * x / m1 : 3 * x * (x - m1) + m1 * m1;
}

/// Cut volume for 0 < alpha ≤ Σm/2 (Scardovelli & Zaleski 2000, eq. 5).
real lower_half(const Sorted& m, real alpha) {
    const real m12 = m[0] + m[1];
    if (alpha >= m12 && alpha <= m[2]) return (alpha - 0.5 * m12) / m[2];
    const real cubes = difference_of_cubes(alpha, m[0]) - difference_of_cubes(alpha - m[1], m[0]) - difference_of_cubes(alpha - m[2], m[0]);
    return cubes / (6 * m[1] * m[2]);
}

/// Area of the cut divided by |m|: the derivative of lower_half.
real slope_of_lower_half(const Sorted& m, real alpha) {
    const auto squares = [&](real x) -> real { return x <= 0 ? 0 : x < m[0] ? x * x / m[0] : 2 * x - m[0]; };
    return (squares(alpha) - squares(alpha - m[1]) - squares(alpha - m[2])) / (2 * m[1] * m[2]);
}

/// The inverse of lower_half between m2 and min(m1 + m2, Σm/2), where it is a cubic: Newton's method within a bracket.
real root_of_cubic(const Sorted& m, real volume, real lo, real hi) {
    real alpha = 0.5 * (lo + hi);
    for (int i = 0; i < 60; ++i) {
        const real excess = lower_half(m, alpha) - volume;
        (excess > 0 ? hi : lo) = alpha;
        real next = alpha - excess / slope_of_lower_half(m, alpha);
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        if (std::abs(next - alpha) <= 1e-16 * hi) break;
        alpha = next;
    }
    return alpha;
}

/// alpha with lower_half(alpha) = volume, for 0 ≤ volume ≤ ½ (Scardovelli & Zaleski 2000, section 3.1).
real intercept(const Sorted& m, real volume) {
    const real m12 = m[0] + m[1], linear_from = m12 <= m[2] ? 0.5 * m12 / m[2] : 1;
    if (volume >= linear_from) return m[2] * volume + 0.5 * m12;
    const real first = m[0] * m[0] / (6 * m[1] * m[2]);
    if (volume < first) return std::cbrt(6 * m[0] * m[1] * m[2] * volume);
    const real second = first + 0.5 * (m[1] - m[0]) / m[2];
    if (volume < second) return 0.5 * (m[0] + std::sqrt(m[0] * m[0] + 8 * m[1] * m[2] * (volume - first)));
    return root_of_cubic(m, volume, m[1], std::min(m12, 0.5 * (m12 + m[2])));
}

/// The normal whose interface is a height function along `axis`: central differences of column sums.
template <int D>
Vec<D> centred_normal(const real* f, const Strides<D>& stride, int axis, real sign) {
    const auto column = [&](std::ptrdiff_t at) {
        const std::ptrdiff_t up = stride[static_cast<std::size_t>(axis)];
        return (f[at - up] + f[at + up]) + f[at];
    };
    Vec<D> m;
    for (int d = 0; d < D; ++d) {
        const std::ptrdiff_t by = stride[static_cast<std::size_t>(d)];
        m[d] = d == axis ? sign : 0.5 * (column(-by) - column(by));
    }
    return m;
}

/// −∇f by weights 1, 2, 1 across each other axis (Youngs 1984).
template <int D>
Vec<D> youngs_normal(const real* f, const Strides<D>& stride) {
    Vec<D> m;
    for (int d = 0; d < D; ++d) {
        const std::ptrdiff_t by = stride[static_cast<std::size_t>(d)], t = stride[static_cast<std::size_t>((d + 1) % D)];
        const auto difference = [&](std::ptrdiff_t at) { return f[at - by] - f[at + by]; };
        const auto across = [&](std::ptrdiff_t at) { return (difference(at - t) + difference(at + t)) + 2 * difference(at); };
        if constexpr (D == 2) {
            m[d] = across(0);
        } else {
            const std::ptrdiff_t s = stride[static_cast<std::size_t>((d + 2) % D)];
            m[d] = (across(-s) + across(s)) + 2 * across(0);
        }
    }
    return m;
}

template <int D>
real sum_of_magnitudes(const Vec<D>& m) {
    real sum = 0;
    for (int d = 0; d < D; ++d) sum += std::abs(m[d]);
    return sum;
}

}  // namespace

template <int D>
real volume_below(Vec<D> m, real alpha) {
    alpha += reflect(m);
    real sum = 0;
    for (int d = 0; d < D; ++d) sum += m[d];
    if (alpha >= sum) return 1;
    if (alpha <= 0) return 0;
    const Sorted s = sorted(m);
    return alpha <= 0.5 * sum ? lower_half(s, alpha) : 1 - lower_half(s, sum - alpha);
}

template <int D>
real plane_constant(Vec<D> m, real fraction) {
    const real shift = reflect(m);
    real sum = 0;
    for (int d = 0; d < D; ++d) sum += m[d];
    const Sorted s = sorted(m);
    const real alpha = fraction <= 0.5 ? intercept(s, std::max(fraction, 0.0)) : sum - intercept(s, std::max(1 - fraction, 0.0));
    return alpha - shift;
}

/// Of the centred normals the one that is steepest along its own axis; Youngs' where that one is less aligned with an axis.
template <int D>
Vec<D> normal_at(const real* f, const Strides<D>& stride) {
    const Vec<D> youngs = youngs_normal<D>(f, stride);
    Vec<D> best{};
    real sum = 0, steepest = 0;
    for (int d = 0; d < D; ++d) {
        const Vec<D> m = centred_normal<D>(f, stride, d, youngs[d] > 0 ? 1 : -1);
        const real all = sum_of_magnitudes(m), along = 1 / all;
        if (along <= steepest) continue;
        steepest = along, sum = all, best = m;
    }
    real largest = 0;
    for (int d = 0; d < D; ++d) largest = std::max(largest, std::abs(youngs[d]));
    const real of_youngs = sum_of_magnitudes(youngs);
    return of_youngs > 0 && steepest > largest / of_youngs ? youngs / of_youngs : best / sum;
}

template <int D>
Plane<D> plane_at(const real* f, const Strides<D>& stride) {
    const Vec<D> m = normal_at<D>(f, stride);
    return {m, plane_constant(m, *f)};
}

template <int D>
real fraction_of_box(const Plane<D>& plane, const Vec<D>& lo, const Vec<D>& hi) {
    Vec<D> m = plane.m;
    for (int d = 0; d < D; ++d) m[d] *= hi[d] - lo[d];
    return volume_below(m, plane.alpha - dot(plane.m, lo));
}

template <int D>
real fraction_of_slab(const Plane<D>& plane, int axis, int end, real width) {
    Vec<D> lo{}, hi = Vec<D>::constant(1);
    if (end == 0)
        hi[axis] = width;
    else
        lo[axis] = 1 - width;
    return fraction_of_box(plane, lo, hi);
}

template <int D>
real fraction_of_slab(const real* f, const Strides<D>& stride, int axis, int end, real width) {
    if (is_empty(*f)) return 0;
    if (is_full(*f)) return 1;
    return fraction_of_slab(plane_at<D>(f, stride), axis, end, width);
}

#define WEIR_INSTANTIATE(D)                                                       \
    template real volume_below(Vec<D>, real);                                     \
    template real plane_constant(Vec<D>, real);                                   \
    template Vec<D> normal_at<D>(const real*, const Strides<D>&);                 \
    template Plane<D> plane_at<D>(const real*, const Strides<D>&);                \
    template real fraction_of_box(const Plane<D>&, const Vec<D>&, const Vec<D>&); \
    template real fraction_of_slab(const Plane<D>&, int, int, real);              \
    template real fraction_of_slab<D>(const real*, const Strides<D>&, int, int, real);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
