// The kernel of all three reconstructions from particles, and what they say of a particle from those around it. Lengths in particle
// spacings.
#pragma once
#include "core/types.hpp"

#include <array>
#include <numbers>

namespace weir::reconstruction {

/// Of the kernel: twice the spacing (Zhu & Bridson 2005, section 5).
inline constexpr real reach = 2;

/// (1 - q^2)^3 of a squared distance in kernel radii: k(s) of Zhu & Bridson 2005.
template <class T>
T bump(T q2) {
    const T left = T(1) - q2;
    return left > T(0) ? left * left * left : T(0);
}
/// Makes the bump's integral over a ball of radius 1 equal to 1.
inline constexpr real bump_norm = 315 / (64 * std::numbers::pi);

/// Below this density, in that of the liquid at rest, a particle is taken to fill more than its own volume. At a plane surface particles
/// have 0.82, on a straight edge 0.65: only drops and sprays change. By itself a particle has 0.2, and would vanish.
inline constexpr real lonely_density = 0.7;

// Yu & Turk 2013, section 4. They look for neighbours within r = 2 h, and take fewer than 25 for a drop: at a plane surface a ball of
// three spacings holds half of 113.
inline constexpr real far_reach = 3;
inline constexpr real nearness = 0.9;  // lambda: how far a particle moves to the mean of its neighbours
/// ... beyond this, the distance of the mean from a particle of a plane surface. As published the whole surface is drawn in by 0.62
/// spacings, and its flat kernels barely reach back out: no level of their sum then is where the liquid ends.
inline constexpr real mean_of_plane = 0.6915;
inline constexpr real farthest_move = 1;   // and no farther than a particle is wide
inline constexpr int few_neighbours = 25;  // N_epsilon
inline constexpr real drop_size = 0.5;     // k_n: the kernel of a drop against that of a particle inside
inline constexpr real flattest = 0.25;     // 1/k_r: the least of the longest axis
inline constexpr real longest = 1.25;      // no axis is longer: that of a sheet of particles is 1.19
/// k_s: makes the covariance of a particle inside, whose neighbours fill the ball evenly, the unit matrix: <x^2> = .15 r^2 with the
/// weights 1 - (d/r)^3.
inline constexpr real inside_scale = 1 / (0.15 * far_reach * far_reach);

/// Sums over the neighbours within far_reach, itself included: weights, their first and second moments about the particle.
struct Moments {
    real weight = 0;
    std::array<real, 3> first{};
    std::array<real, 6> second{};  // xx yy zz xy xz yz
    int count = 0;
};

/// A kernel as an ellipsoid, of the radius of the neighbourhood for a particle inside: w(x) = volume norm |stretch| bump(|stretch (x -
/// centre)|^2).
struct Blob {
    Vec<3> centre{};
    std::array<real, 6> stretch{};  // symmetric: xx yy zz xy xz yz [1/spacing]
    Vec<3> half{};                  // of the box around it
    real peak = 0;                  // volume norm |stretch|
};

/// Equations 6 and 9-16 of Yu & Turk 2013, for a particle at x. Its m/rho is 1, that of the liquid at rest, where it has neighbours enough,
/// else `volume` [spacing^3]: the density of particles at the surface, half of whose neighbours are missing, would raise the sum there to
/// one and a half of what it is inside.
Blob stretched(const Vec<3>& x, const Moments& m, real volume);

}  // namespace weir::reconstruction
