#include "water/curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace weir::water {

namespace {

constexpr int reach = 2;  // cells on either side that are read
template <int D>
constexpr real width =
    D == 2 ? 2.2 : 2.5;          // cells: distance at which the weight of a crossing vanishes; a larger one reverses forces on short waves
constexpr real slanted = 0.3;    // minimum of the normal's component along a grid line; below it the crossing is inaccurate
constexpr real steepest = 0.75;  // maximum slope of the surface against its tangent plane, at half a cell and more: else another surface

/// φ in the cells around one, mirrored at walls.
template <int D>
struct Window {
    static constexpr int side = 2 * reach + 1;
    std::array<real, D == 2 ? side * side : side * side * side> phi;
    static int stride(int a) { return a == 0 ? 1 : a == 1 ? side : side * side; }

    Window(const Grid<real, D>& all, const Frame<D>& frame, const Index<D>& I) {
        bool inside = true;
        for (int d = 0; d < D; ++d) inside = inside && I[d] >= reach && I[d] + reach < frame.cells[d];
        if (inside)
            copy(&all(I), all);
        else
            copy_mirrored(all, frame, I);
    }
    void copy_mirrored(const Grid<real, D>& all, const Frame<D>& frame, const Index<D>& I) {
        for (std::size_t at = 0; at < phi.size(); ++at) {
            const Vec<D> by = offset(at);
            Index<D> J = I;
            for (int d = 0; d < D; ++d) {
                const int n = frame.cells[d];
                int i = I[d] + static_cast<int>(by[d]);
                if (frame.periodic(d))
                    i = (i + n) % n;
                else
                    i = std::clamp(i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i, 0, n - 1);
                J[d] = i;
            }
            phi[at] = all(J);
        }
    }
    void copy(const real* middle, const Grid<real, D>& all) {
        real* to = phi.data();
        for (int k = D == 2 ? 0 : -reach; k <= (D == 2 ? 0 : reach); ++k)
            for (int j = -reach; j <= reach; ++j, to += side)
                std::copy_n(middle + (D == 2 ? 0 : k * all.stride(D - 1)) + j * all.stride(1) - reach, side, to);
    }
    /// Offset from the centre [cells].
    static Vec<D> offset(std::size_t at) {
        Vec<D> by;
        auto rest = static_cast<int>(at);
        for (int d = 0; d < D; ++d, rest /= side) by[d] = rest % side - reach;
        return by;
    }
};

/// Normal equations of a least-squares fit with n coefficients.
template <int n>
struct Fit {
    std::array<std::array<real, n + 1>, n> rows{};
    void add(const std::array<real, n>& basis, real value, real weight) {
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j <= i; ++j) rows[i][j] += weight * basis[i] * basis[j];
            rows[i][n] += weight * basis[i] * value;
        }
    }
    /// Cholesky's method; false where the points do not determine all coefficients.
    bool solve(std::array<real, n>& x) {
        constexpr real dependent = 1e-6;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                real sum = rows[i][j];
                for (std::size_t k = 0; k < j; ++k) sum -= rows[i][k] * rows[j][k];
                if (i == j && !(sum > dependent * rows[i][i])) return false;
                rows[i][j] = i == j ? std::sqrt(sum) : sum / rows[j][j];
            }
        for (std::size_t i = 0; i < n; ++i) {
            real sum = rows[i][n];
            for (std::size_t k = 0; k < i; ++k) sum -= rows[i][k] * x[k];
            x[i] = sum / rows[i][i];
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t k = i + 1; k < n; ++k) x[i] -= rows[k][i] * x[k];
            x[i] /= rows[i][i];
        }
        return true;
    }
};

/// Two tangent directions of the surface.
template <int D>
std::array<Vec<D>, D - 1> tangents(const Vec<D>& n) {
    if constexpr (D == 2) {
        return {Vec<D>{{-n[1], n[0]}}};
    } else {
        int least = 0;
        for (int d = 1; d < D; ++d)
            if (std::abs(n[d]) < std::abs(n[least])) least = d;
        Vec<D> t = -n[least] * n;
        t[least] += 1;
        t = t / norm(t);
        return {t, Vec<D>{{n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]}}};
    }
}

/// Central and second differences at the cell itself.
template <int D>
real curvature_of_differences(const Window<D>& window, const Frame<D>& frame) {
    const std::size_t middle = window.phi.size() / 2;
    const auto at = [&](int step) { return window.phi[static_cast<std::size_t>(static_cast<int>(middle) + step)]; };
    Vec<D> g;
    real laplacian = 0, bending = 0, g2 = 0;
    for (int a = 0; a < D; ++a) {
        const int s = Window<D>::stride(a);
        g[a] = 0.5 * (at(s) - at(-s)) * frame.inv_h[a];
        g2 += g[a] * g[a];
    }
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) {
            const int s = Window<D>::stride(a), t = Window<D>::stride(b);
            const real second = frame.inv_h[a] * frame.inv_h[b] *
                                (a == b ? at(s) - 2 * at(0) + at(-s) : 0.25 * (at(s + t) - at(s - t) - at(t - s) + at(-s - t)));
            if (a == b) laplacian += second;
            bending += g[a] * g[b] * second;
        }
    return g2 > 1e-6 ? (laplacian - bending / g2) / std::sqrt(g2) : 0;
}

/// A crossing of the surface with a grid line along `axis`: at fraction θ between two cells, φ rising (1) or falling (−1).
template <int D>
struct Crossing {
    Vec<D> x;  // from the cell's centre [m]
    real theta;
    int axis, rising;
};

template <int D>
struct Crossings {
    static constexpr int side = Window<D>::side, most = D * (side - 1) * (D == 2 ? side : side * side);
    std::array<Crossing<D>, most> list;
    std::size_t count = 0;

    Crossings(const Window<D>& window, const Frame<D>& frame) {
        for (std::size_t at = 0; at < window.phi.size(); ++at)
            for (int a = 0; a < D; ++a) {
                const real here = window.phi[at];
                const int place = static_cast<int>(at) / Window<D>::stride(a) % side;
                if (place + 1 == side) continue;
                const real next = window.phi[at + static_cast<std::size_t>(Window<D>::stride(a))];
                if ((here < 0) == (next < 0)) continue;
                const Vec<D> by = Window<D>::offset(at);
                Crossing<D>& to = list[count++];
                to = {{}, here / (here - next), a, next > here ? 1 : -1};
                for (int d = 0; d < D; ++d) to.x[d] = frame.h[d] * (by[d] + (d == a ? to.theta : 0));
            }
    }
};

/// κ of the fit, or NaN. Linear interpolation between distances has a parabolic error for a surface of curvature `bend`.
template <int D>
real fitted(const Crossings<D>& crossings, const Frame<D>& frame, const Vec<D>& n, const Vec<D>& foot, real bend) {
    constexpr int coefficients = D == 2 ? 3 : 6;
    const auto t = tangents<D>(n);
    const real h = frame.h_max();
    Fit<coefficients> fit;
    for (std::size_t i = 0; i < crossings.count; ++i) {
        auto [x, theta, a, rising] = crossings.list[i];
        const Vec<D> from_foot = x - foot, side = bend * (from_foot - dot(n, from_foot) * n);
        const real across = (n[a] + side[a]) / std::sqrt(1 + dot(side, side));  // component of the normal there
        if (rising * across < slanted) continue;                                // the other side of a sheet, or an inaccurate crossing
        x[a] += 0.5 * theta * (1 - theta) * frame.h[a] * frame.h[a] * bend * (1 - across * across) / across;
        const Vec<D> r = x - foot;
        const real up = dot(n, r) / h, far2 = dot(r, r) / (h * h * width<D> * width<D>);
        std::array<real, D - 1> s;
        real s2 = 0;
        for (std::size_t k = 0; k + 1 < D; ++k) s[k] = dot(t[k], r) / h, s2 += s[k] * s[k];
        if (far2 >= 1 || std::abs(up) > 0.5 + steepest * std::sqrt(s2)) continue;
        const real weight = (1 - far2) * (1 - far2);
        if constexpr (D == 2)
            fit.add({1, s[0], s[0] * s[0]}, up, weight);
        else
            fit.add({1, s[0], s[1], s[0] * s[0], s[0] * s[1], s[1] * s[1]}, up, weight);
    }
    std::array<real, coefficients> c{};
    if (!fit.solve(c)) return std::nan("");
    if constexpr (D == 2) {
        const real slope = 1 + c[1] * c[1];
        return -2 * c[2] / (slope * std::sqrt(slope)) / h;
    } else {
        const real p = c[1], q = c[2], slope = 1 + p * p + q * q;
        return -2 * ((1 + q * q) * c[3] - p * q * c[4] + (1 + p * p) * c[5]) / (slope * std::sqrt(slope)) / h;
    }
}

}  // namespace

template <int D>
real curvature_near(const Grid<real, D>& phi, const Frame<D>& frame, const Index<D>& I) {
    const Window<D> window(phi, frame, I);
    const real limit = (D - 1) / frame.h_min();  // of a drop as small as a cell
    const real differences = std::clamp(curvature_of_differences(window, frame), -limit, limit);
    const std::size_t middle = window.phi.size() / 2;
    Vec<D> n;
    for (int a = 0; a < D; ++a) {
        const auto s = static_cast<std::size_t>(Window<D>::stride(a));
        n[a] = (window.phi[middle + s] - window.phi[middle - s]) * 0.5 * frame.inv_h[a];
    }
    const real steep = norm(n);
    if (steep < 1e-3) return differences;
    n = n / steep;
    const Vec<D> foot = -(window.phi[middle] / std::max(steep, 0.5)) * n;
    const Crossings<D> crossings(window, frame);
    const real rough = fitted(crossings, frame, n, foot, 0.0);
    const real kappa = fitted(crossings, frame, n, foot, std::clamp(rough, -limit, limit) / (D - 1));  // NaN is kept
    return std::isnan(kappa) ? differences : std::clamp(kappa, -limit, limit);
}

template real curvature_near(const Grid<real, 2>&, const Frame<2>&, const Index<2>&);
template real curvature_near(const Grid<real, 3>&, const Frame<3>&, const Index<3>&);

}  // namespace weir::water
