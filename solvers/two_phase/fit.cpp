#include "two_phase/fit.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

namespace {

constexpr int unknowns(int dim) { return dim == 2 ? 3 : 6; }
constexpr real least_fraction = 1e-6;  // the plane of a cell with less of one phase has an uncertain normal
constexpr real least_cosine = 0.2;     // between normals: planes of another part of the surface are left out
constexpr real squared_reach = 6.5;    // cells²: the 5^D cells without their corners

/// D − 1 unit vectors across n.
template <int D>
std::array<Vec<D>, D - 1> across(const Vec<D>& n) {
    if constexpr (D == 2) {
        return {Vec<2>{{-n[1], n[0]}}};
    } else {
        int least = 0;
        for (int d = 1; d < 3; ++d)
            if (std::abs(n[d]) < std::abs(n[least])) least = d;
        Vec<3> t = Vec<3>::unit(least) - n[least] * n;
        t = t / norm(t);
        return {t, Vec<3>{{n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]}}};
    }
}

/// Where a plane meets the edges of the cell; a corner may be listed more than once. Returns their number.
template <int D>
int cut_edges(const Plane<D>& plane, std::array<Vec<D>, D == 2 ? 4 : 12>& points) {
    int count = 0;
    for (int d = 0; d < D; ++d) {
        if (std::abs(plane.m[d]) < 1e-12) continue;
        for (int corner = 0; corner < (1 << (D - 1)); ++corner) {
            Vec<D> x{};
            for (int k = 0; k + 1 < D; ++k) x[(d + 1 + k) % D] = corner >> k & 1;
            x[d] = (plane.alpha - dot(plane.m, x)) / plane.m[d];
            if (x[d] >= 0 && x[d] <= 1) points[static_cast<std::size_t>(count++)] = x;
        }
    }
    return count;
}

/// Area-weighted middle of a convex polygon in space, whose corners are sorted around their mean.
Vec<3> middle_of_polygon(std::array<Vec<3>, 12>& points, int count, const Vec<3>& n) {
    Vec<3> mean{};
    for (int i = 0; i < count; ++i) mean += points[static_cast<std::size_t>(i)] / count;
    const auto [t, s] = across(n);
    const auto angle = [&, t = t, s = s](const Vec<3>& x) { return std::atan2(dot(x - mean, s), dot(x - mean, t)); };
    std::sort(points.begin(), points.begin() + count, [&](const Vec<3>& a, const Vec<3>& b) { return angle(a) < angle(b); });
    Vec<3> sum{};
    real area = 0;
    for (int i = 0; i < count; ++i) {
        const Vec<3> a = points[static_cast<std::size_t>(i)] - mean, b = points[static_cast<std::size_t>((i + 1) % count)] - mean;
        const Vec<3> cross{{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
        const real twice = norm(cross);
        area += twice;
        sum += twice / 3 * (a + b);
    }
    return area > 0 ? mean + sum / area : mean;
}

/// Solves the normal equations S x = r by elimination with pivots. False where they are singular.
template <int N>
bool solve(std::array<std::array<real, N + 1>, N>& S, std::array<real, N>& x) {
    for (std::size_t c = 0; c < N; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c + 1; r < N; ++r)
            if (std::abs(S[r][c]) > std::abs(S[pivot][c])) pivot = r;
        if (std::abs(S[pivot][c]) < 1e-10) return false;
        std::swap(S[c], S[pivot]);
        for (std::size_t r = 0; r < N; ++r) {
            if (r == c) continue;
            const real factor = S[r][c] / S[c][c];
            for (std::size_t k = c; k <= N; ++k) S[r][k] -= factor * S[c][k];
        }
    }
    for (std::size_t c = 0; c < N; ++c) x[c] = S[c][N] / S[c][c];
    return true;
}

/// The sums of a weighted least-squares fit z = a s² + b s + c, or a s² + b t² + c s t + d s + e t + f.
template <int D>
struct Fit {
    static constexpr int N = unknowns(D);
    std::array<std::array<real, N + 1>, N> sums{};
    int count = 0;

    void add(const std::array<real, D - 1>& s, real z, real weight) {
        std::array<real, N> phi;
        if constexpr (D == 2)
            phi = {s[0] * s[0], s[0], 1};
        else
            phi = {s[0] * s[0], s[1] * s[1], s[0] * s[1], s[0], s[1], 1};
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t j = 0; j < N; ++j) sums[i][j] += weight * phi[i] * phi[j];
            sums[i][N] += weight * phi[i] * z;
        }
        ++count;
    }
    bool graph(Graph& g) {
        std::array<real, N> x;
        if (count <= N || !solve<N>(sums, x)) return false;
        if constexpr (D == 2)
            g = {.x = x[1], .xx = 2 * x[0]};
        else
            g = {.x = x[3], .y = x[4], .xx = 2 * x[0], .yy = 2 * x[1], .xy = x[2]};
        return true;
    }
};

/// The middle and unit normal of the plane of a cell, in physical space with the lower corner of cell 0 as origin.
template <int D>
bool middle_of_plane(const Interface<D>& s, const Index<D>& I, Vec<D>& x, Vec<D>& n) {
    const real f = s.padded(I);
    if (f <= least_fraction || f >= 1 - least_fraction) return false;
    const Plane<D> plane = plane_at<D>(s.padded.at(I), strides_of(s.padded));
    if (!middle_of_cut(plane, x)) return false;
    for (int d = 0; d < D; ++d) {
        x[d] = s.h[d] * (I[d] + x[d]);
        n[d] = plane.m[d] / s.h[d];
    }
    n = n / norm(n);
    return true;
}

}  // namespace

template <int D>
Vec<D> physical_normal(const Interface<D>& s, const Index<D>& I) {
    Vec<D> n = normal_at<D>(s.padded.at(I), strides_of(s.padded));
    for (int d = 0; d < D; ++d) n[d] /= s.h[d];
    const real length = norm(n);
    return length > 0 ? n / length : Vec<D>::unit(0);
}

template <int D>
bool middle_of_cut(const Plane<D>& plane, Vec<D>& middle) {
    std::array<Vec<D>, D == 2 ? 4 : 12> points;
    const int count = cut_edges(plane, points);
    if (count < D) return false;
    if constexpr (D == 3) {
        middle = middle_of_polygon(points, count, plane.m / norm(plane.m));
    } else {
        const Vec<2> t{{-plane.m[1], plane.m[0]}};
        const auto [first, last] = std::minmax_element(points.begin(), points.begin() + count,
                                                       [&](const Vec<2>& a, const Vec<2>& b) { return dot(a, t) < dot(b, t); });
        middle = 0.5 * (*first + *last);
    }
    return true;
}

template <int D>
real curvature_by_fit(const Interface<D>& s, const Index<D>& I) {
    Vec<D> x0, n, x, m;
    if (!middle_of_plane(s, I, x0, n)) return no_curvature;
    const auto t = across(n);
    const real h = *std::min_element(s.h.begin(), s.h.end());
    Fit<D> fit;
    for (int code = 0; code < (D == 2 ? 25 : 125); ++code) {
        Index<D> J = I;
        for (int d = 0, rest = code; d < D; ++d, rest /= 5) J[d] += rest % 5 - 2;
        if (!middle_of_plane(s, J, x, m) || dot(m, n) < least_cosine) continue;
        const Vec<D> y = (x - x0) / h;
        const real squared = dot(y, y);
        if (squared > squared_reach) continue;
        std::array<real, D - 1> along;
        for (std::size_t k = 0; k + 1 < D; ++k) along[k] = dot(y, t[k]);
        fit.add(along, dot(y, n), 1 / (1 + 0.5 * squared));
    }
    Graph g;
    if (!fit.graph(g)) return no_curvature;
    return std::clamp<real>(curvature_of(g), 1 - D, D - 1) / h;
}

#define WEIR_INSTANTIATE(D)                                                \
    template Vec<D> physical_normal(const Interface<D>&, const Index<D>&); \
    template bool middle_of_cut(const Plane<D>&, Vec<D>&);                 \
    template real curvature_by_fit(const Interface<D>&, const Index<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
