// Shapes of two phases in the unit box, and the pressure matrix of their densities: the problems of the two-phase pressure.
//
//   w_f = ρ_l / ρ_f = 2 / (ρ_lower + ρ_upper)     ρ of a cell = f + (1 − f) / ratio, in densities of the liquid; f: its liquid part
//
// All cells are fluid and all sides closed. f is the part of 4 (2 in 3D) points along each axis that lie in the liquid.
#pragma once
#include "poisson/poisson.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace weir::bench {

/// A number in [0, 1) from an integer (the finalizer of MurmurHash3).
inline real random_of(std::uint64_t i) {
    i ^= i >> 33, i *= 0xff51afd7ed558ccdULL, i ^= i >> 33, i *= 0xc4ceb9fe1a85ec53ULL, i ^= i >> 33;
    return static_cast<real>(i >> 11) / 9007199254740992.0;
}

/// Signed distance-like function of a cloud: one sphere at a random place in each cell of a lattice of m cells along an axis (12 in 2D:
/// 144 spheres; 6 in 3D: 216), of radius 0.1 to 0.32 lattice cells; positive inside.
template <int D>
real cloud(const Vec<D>& x) {
    constexpr int m = D == 2 ? 12 : 6;
    real inside = -infinity;
    Index<D> lo{}, hi{};
    for (int a = 0; a < D; ++a) {
        const int home = static_cast<int>(x[a] * m);
        lo[a] = std::max(0, home - 1), hi[a] = std::min(m, home + 2);
    }
    for_each_in(lo, replicated(hi), [&](const Index<D>& K) {
        std::uint64_t id = 0;
        for (int a = D - 1; a >= 0; --a) id = id * 1000 + static_cast<std::uint64_t>(K[a] + 50);
        Vec<D> away;
        for (int a = 0; a < D; ++a) away[a] = x[a] - (K[a] + 0.5 + 0.3 * (random_of(id * 7 + static_cast<std::uint64_t>(a)) - 0.5)) / m;
        inside = std::max(inside, (0.1 + 0.22 * random_of(id * 7 + 5)) / m - norm(away));
    });
    return inside;
}

/// Distance from the midline of a film: level and shifted by a cell, inclined, or closed to a ring or shell.
template <int D>
bool film_distance(const std::string& film, const Vec<D>& x, const Vec<D>& from_centre, real h, real& distance) {
    const real up = x[D - 1] - 0.5, along = x[0] - 0.5 + (D == 3 ? 0.5 * (x[1] - 0.5) : 0);
    if (film == "level_film") return distance = up - 1.1 * h, true;
    if (film == "inclined_film") return distance = (up - 0.3 * along) / std::sqrt(D == 3 ? 1.1125 : 1.09) - 0.3 * h, true;
    if (film == "ring_film") return distance = norm(from_centre) - 0.31, true;
    return false;
}

/// Positive in the liquid at x; h is the width of a cell. false for an unknown shape.
template <int D>
bool liquid_at(const std::string& shape, const Vec<D>& x, real h, real& depth) {
    const real up = x[D - 1], wave = 0.5 + 0.05 * std::cos(2 * pi * x[0]) * (D == 3 ? std::cos(2 * pi * x[1]) : 1);
    Vec<D> from_centre;
    for (int a = 0; a < D; ++a) from_centre[a] = x[a] - 0.5;
    if (shape == "uniform") return depth = 1, true;
    if (shape == "wave") return depth = wave - up, true;
    if (shape == "bubble") return depth = norm(from_centre) - 0.25, true;
    if (shape == "drop") return depth = 0.25 - norm(from_centre), true;
    if (shape == "dam") return depth = std::min(0.3 - x[0], 0.6 - up), true;
    if (shape == "drops") return depth = cloud(x), true;
    if (shape == "bubbles") return depth = -cloud(x), true;
    if (shape == "film") return depth = h - std::abs(wave - up), true;
    if (shape == "gas_film") return depth = std::abs(wave - up) - h, true;
    const bool gas = shape.starts_with("gas_");
    if (real away; film_distance(gas ? shape.substr(4) : shape, x, from_centre, h, away))
        return depth = gas ? std::abs(away) - h : h - std::abs(away), true;
    return false;
}

/// The liquid part of each cell of a box of n cells along each axis; empty for an unknown shape.
template <int D>
Grid<real, D> liquid_parts(const std::string& shape, int n) {
    constexpr int points = D == 2 ? 4 : 2;
    real unused = 0;
    if (!liquid_at<D>(shape, {}, 1.0 / n, unused)) return {};
    Grid<real, D> part(replicated(Index<D>::constant(n)));
    for_each_cell<D>(part.extent(), [&](const Index<D>& I) {
        real sum = 0, depth = 0;
        Vec<D> centre;
        for (int a = 0; a < D; ++a) centre[a] = (I[a] + 0.5) / n;
        liquid_at<D>(shape, centre, 1.0 / n, depth);
        if (std::abs(depth) > 2.0 / n) return void(part(I) = depth > 0);  // slopes are at most 1.1: no interface in the cell
        for_each_in(Index<D>::constant(0), replicated(Index<D>::constant(points)), [&](const Index<D>& P) {
            Vec<D> x;
            for (int a = 0; a < D; ++a) x[a] = (I[a] + (P[a] + 0.5) / points) / n;
            liquid_at<D>(shape, x, 1.0 / n, depth);
            sum += depth > 0;
        });
        part(I) = sum / std::pow(points, D);
    });
    return part;
}

/// The matrix of such liquid parts at a ratio of densities.
template <int D>
poisson::Operator<D> two_phase_operator(const Grid<real, D>& part, real ratio) {
    poisson::Operator<D> A;
    A.cells = Grid<poisson::Cell, D>(part.extent(), poisson::Cell::fluid);
    A.light = Grid<std::uint8_t, D>(part.extent());
    for (std::size_t i = 0; i < part.size(); ++i) A.light[i] = part[i] < 0.5;
    const auto density = [&](const Index<D>& I) { return part(I) + (1 - part(I)) / ratio; };
    for (int a = 0; a < D; ++a) {
        auto& w = A.weight[static_cast<std::size_t>(a)];
        w = Grid<real, D>(part.extent() + e<D>(a), 0);
        for_each_cell<D>(w.extent(), [&](const Index<D>& I) {
            if (I[a] > 0 && I[a] < part.extent()[a]) w(I) = 2 / (density(I - e<D>(a)) + density(I));
        });
    }
    return A;
}

}  // namespace weir::bench
