#include "free_surface/plane_cut.hpp"

#include <algorithm>
#include <cmath>

namespace weir::free_surface {

namespace {

constexpr real flat = 1e-4;  // a smaller slope changes the volume by less than 1e-8, and the formulas lose digits

/// Root of a3 a³ + a2 a² + a1 a + a0 between its other two (Scardovelli & Zaleski 2000, appendix).
real middle_root(real a3, real a2, real a1, real a0) {
    a2 /= a3, a1 /= a3, a0 /= a3;
    const real p = std::min(a1 / 3 - a2 * a2 / 9, 0.0), q = (a1 * a2 - 3 * a0) / 6 - a2 * a2 * a2 / 27, r = std::sqrt(-p);
    const real theta = std::acos(std::clamp(r > 0 ? q / (r * r * r) : 0.0, -1.0, 1.0)) / 3;
    return r * (std::sqrt(3.0) * std::sin(theta) - std::cos(theta)) - a2 / 3;
}

/// a with {x in [0, 1]² : m·x < a} = V ≤ ½, m1 ≤ m2, m1 + m2 = 1.
real intercept_2d(real V, real m1, real m2) { return 2 * V * m2 < m1 ? std::sqrt(2 * m1 * m2 * V) : V * m2 + 0.5 * m1; }

/// The same in the unit cube, m1 ≤ m2 ≤ m3.
real intercept_3d(real V, real m1, real m2, real m3) {
    const real m12 = m1 + m2, volume = 6 * m1 * m2 * m3;
    const real V1 = m1 * m1 / (6 * m2 * m3), V2 = V1 + 0.5 * (m2 - m1) / m3;
    if (V < V1) return std::cbrt(volume * V);
    if (V < V2) return 0.5 * (m1 + std::sqrt(m1 * m1 + 8 * m2 * m3 * (V - V1)));
    const real V3 = m3 < m12 ? (m3 * m3 * (3 * m12 - m3) + m1 * m1 * (m1 - 3 * m3) + m2 * m2 * (m2 - 3 * m3)) / volume : 0.5 * m12 / m3;
    const real cubes = m1 * m1 * m1 + m2 * m2 * m2 - volume * V;
    if (V < V3) return middle_root(-1, 3 * m12, -3 * (m1 * m1 + m2 * m2), cubes);
    if (m3 >= m12) return m3 * V + 0.5 * m12;
    return middle_root(-2, 3, -3 * (m1 * m1 + m2 * m2 + m3 * m3), cubes + m3 * m3 * m3);
}

}  // namespace

template <int D>
real fraction_below_plane(real value, const Vec<D>& g) {
    real alpha = -value, steep = 0;
    for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
    if (std::abs(value) >= 0.5 * steep) return value < 0 ? 1 : 0;
    std::array<real, D> m;
    int count = 0;
    real norm = 1;
    for (int d = 0; d < D; ++d)
        if (std::abs(g[d]) > flat * steep) {
            m[static_cast<std::size_t>(count++)] = std::abs(g[d]);
            alpha += 0.5 * std::abs(g[d]);
        }
    for (int i = 0; i < count; ++i) norm *= m[static_cast<std::size_t>(i)] * (i + 1);
    real volume = 0;
    for (int corner = 0; corner < (1 << count); ++corner) {
        real reach = alpha;
        bool odd = false;
        for (int i = 0; i < count; ++i)
            if (corner >> i & 1) reach -= m[static_cast<std::size_t>(i)], odd = !odd;
        if (reach <= 0) continue;
        real power = 1;
        for (int i = 0; i < count; ++i) power *= reach;
        volume += odd ? -power : power;
    }
    return std::clamp(volume / norm, 0.0, 1.0);
}

template <int D>
real plane_with_fraction(real fraction, const Vec<D>& g) {
    real steep = 0, sum = 0;
    for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
    std::array<real, D> m;
    int count = 0;
    for (int d = 0; d < D; ++d)
        if (std::abs(g[d]) > flat * steep) sum += m[static_cast<std::size_t>(count++)] = std::abs(g[d]);
    for (int i = 0; i < count; ++i) m[static_cast<std::size_t>(i)] /= sum;
    std::sort(m.begin(), m.begin() + count);
    const real V = std::min(fraction, 1 - fraction);
    real a = V;
    if (count == 2) a = intercept_2d(V, m[0], m[1]);
    if constexpr (D == 3)
        if (count == 3) a = intercept_3d(V, m[0], m[1], m[2]);
    return sum * (fraction <= 0.5 ? 0.5 - a : a - 0.5);
}

template real fraction_below_plane(real, const Vec<2>&);
template real fraction_below_plane(real, const Vec<3>&);
template real plane_with_fraction(real, const Vec<2>&);
template real plane_with_fraction(real, const Vec<3>&);

}  // namespace weir::free_surface
