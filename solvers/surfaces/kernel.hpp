// The kernel of the three particle reconstructions, and the properties of a particle computed from its neighbours. Lengths in particle
// spacings.
#pragma once
#include "core/types.hpp"

#include <array>
#include <numbers>

namespace weir::surfaces {

/// Kernel radius: twice the spacing (Zhu & Bridson 2005, section 5).
inline constexpr real reach = 2;

/// (1 - q^2)^3 of a squared distance in kernel radii: k(s) of Zhu & Bridson 2005.
template <class T>
T bump(T q2) {
    const T left = T(1) - q2;
    return left > T(0) ? left * left * left : T(0);
}
/// Normalizes the bump: its integral over a ball of radius 1 becomes 1.
inline constexpr real bump_norm = 315 / (64 * std::numbers::pi);

/// Below this density, relative to the liquid at rest, a particle represents more than its own volume. Particles have 0.82 at a plane
/// surface and 0.65 at a straight edge, so only drops and sprays change. A single particle has 0.2, and would vanish.
inline constexpr real lonely_density = 0.7;

// Yu & Turk 2013, section 4. They search neighbours within r = 2 h; fewer than 25 form a drop. At a plane surface a ball of three spacings
// contains half of 113.
inline constexpr real far_reach = 3;
inline constexpr real nearness = 0.9;  // lambda: fraction of the way to the mean of the neighbours that a particle moves
/// ... beyond this, the distance of the mean from a particle at a plane surface. In the published form the whole surface moves inwards by
/// 0.62 spacings, and its flat kernels barely reach back: then no level of their sum lies at the end of the liquid.
inline constexpr real mean_of_plane = 0.6915;
inline constexpr real farthest_move = 1;   // limited to the width of a particle
inline constexpr int few_neighbours = 25;  // N_epsilon
inline constexpr real drop_size = 0.5;     // k_n: the kernel of a drop relative to that of an interior particle
inline constexpr real flattest = 0.25;     // 1/k_r: minimum relative to the longest axis
inline constexpr real longest = 1.25;      // maximum of all axes: that of a sheet of particles is 1.19
/// k_s: makes the covariance of an interior particle, with uniformly distributed neighbours, the unit matrix: <x^2> = .15 r^2 with the
/// weights 1 - (d/r)^3.
inline constexpr real inside_scale = 1 / (0.15 * far_reach * far_reach);

/// Sums over the neighbours within far_reach, including the particle: weights, their first and second moments about the particle.
struct Moments {
    real weight = 0;
    std::array<real, 3> first{};
    std::array<real, 6> second{};  // xx yy zz xy xz yz
    int count = 0;
};

/// An ellipsoidal kernel, with the radius of the neighbourhood for an interior particle: w(x) = volume norm |stretch| bump(|stretch (x -
/// centre)|^2).
struct Blob {
    Vec<3> centre{};
    std::array<real, 6> stretch{};  // symmetric: xx yy zz xy xz yz [1/spacing]
    Vec<3> half{};                  // half extents of its bounding box
    real peak = 0;                  // volume norm |stretch|
};

/// Equations 6 and 9-16 of Yu & Turk 2013, for a particle at x. Its m/rho is 1, that of the liquid at rest, if it has enough neighbours,
/// otherwise `volume` [spacing^3]. With the density of surface particles, which lack half of their neighbours, the sum there would be one
/// and a half times that inside.
Blob stretched(const Vec<3>& x, const Moments& m, real volume);

}  // namespace weir::surfaces
