#include "waves/stokes.hpp"

#include <cmath>

namespace weir::waves {

namespace {

using Powers = std::array<std::array<real, 5>, 5>;  // [power of e - 1][harmonic - 1]

/// Larger k d count as deep water, exact to the last bit: sech(2 k d) = 5e-16.
constexpr real deep = 18;

real pow_i(real x, int n) { return n == 0 ? 1 : x * pow_i(x, n - 1); }
/// c[0] + c[1] S + c[2] S^2 + ...
real poly(real S, std::initializer_list<real> c) {
    real sum = 0, power = 1;
    for (const real one : c) sum += one * power, power *= S;
    return sum;
}

/// B: k eta = sum e^i sum B_ij cos(j theta)
Powers of_surface(real S, real C) {
    const auto r = [&](int n) { return pow_i(1 - S, n); };
    Powers B{};
    B[0][0] = 1;
    B[1][1] = C * (1 + 2 * S) / (2 * r(1));
    B[2][0] = -3 * poly(S, {1, 3, 3, 2}) / (8 * r(3));
    B[2][2] = -B[2][0];
    B[3][1] = C * poly(S, {6, -26, -182, -204, -25, 26}) / (6 * (3 + 2 * S) * r(4));
    B[3][3] = C * poly(S, {24, 92, 122, 66, 67, 34}) / (24 * (3 + 2 * S) * r(4));
    B[4][2] = 9 * poly(S, {132, 17, -2216, -5897, -6292, -2687, 194, 467, 82}) / (128 * (3 + 2 * S) * (4 + S) * r(6));
    B[4][4] = 5 * poly(S, {300, 1579, 3176, 2949, 1188, 675, 1326, 827, 130}) / (384 * (3 + 2 * S) * (4 + S) * r(6));
    B[4][0] = -(B[4][2] + B[4][4]);
    return B;
}

/// A sinh(k d): u = C0 sqrt(g/k) sum e^i sum A_ij j cosh(j k (y + d)) cos(j theta). sinh: that of k d.
Powers of_flow(real S, real sinh) {
    const auto r = [&](int n) { return pow_i(1 - S, n); };
    Powers A{};
    A[0][0] = 1 / sinh;
    A[1][1] = 3 * S * S / (2 * r(2));
    A[2][0] = poly(S, {-4, -20, 10, -13}) / (8 * sinh * r(3));
    A[2][2] = poly(S, {0, 0, -2, 11}) / (8 * sinh * r(3));
    A[3][1] = poly(S, {0, 12, -14, -264, -45, -13}) / (24 * r(5));
    A[3][3] = poly(S, {0, 0, 0, 10, -174, 291, 278}) / (48 * (3 + 2 * S) * r(5));
    A[4][0] = poly(S, {-1184, 32, 13232, 21712, 20940, 12554, -500, -3341, -670}) / (64 * sinh * (3 + 2 * S) * (4 + S) * r(6));
    A[4][2] = poly(S, {0, 4, 105, 198, -1376, -1302, -117, 58}) / (32 * sinh * (3 + 2 * S) * r(6));
    A[4][4] = poly(S, {0, 0, 0, -6, 272, -1552, 852, 2029, 430}) / (64 * sinh * (3 + 2 * S) * (4 + S) * r(6));
    return A;
}

}  // namespace

Stokes::Stokes(const StokesWave& wave) : wave_(wave), depth_(std::min(wave.depth, deep / wave.k)) {
    const real k = wave.k, kd = k * depth_, e = 0.5 * k * wave.height, S = 1 / std::cosh(2 * kd), C = 1 / std::tanh(kd);
    const real C0 = std::sqrt(std::tanh(kd)), scale = C0 * std::sqrt(wave.g / k);
    const Powers B = of_surface(S, C), A = of_flow(S, std::sinh(kd));
    for (std::size_t j = 0; j < 5; ++j)
        for (std::size_t i = 0; i < static_cast<std::size_t>(wave.order); ++i) {
            const real power = pow_i(e, static_cast<int>(i) + 1), harmonic = static_cast<real>(j + 1);
            surface_[j] += power * B[i][j] / k;
            flow_[j] += scale * power * A[i][j] * harmonic * std::cosh(harmonic * kd);
        }
    const real C2 = C0 * (2 + 7 * S * S) / (4 * pow_i(1 - S, 2)), C4 = C0 * poly(S, {4, 32, -116, -400, -71, 146}) / (32 * pow_i(1 - S, 5));
    speed_ = std::sqrt(wave.g / k) * (C0 + (wave.order >= 3 ? e * e * C2 : 0) + (wave.order >= 5 ? pow_i(e, 4) * C4 : 0));
}

real Stokes::height_at(real theta) const {
    real sum = 0;
    for (std::size_t j = 0; j < 5; ++j) sum += surface_[j] * std::cos(static_cast<real>(j + 1) * theta);
    return sum;
}

/// cosh(j k (y + d)) / cosh(j k d) = e^(j k y) (1 + e^(-2 j k (y + d))) / (1 + e^(-2 j k d))
Vec<3> Stokes::velocity_at(real theta, real y) const {
    real along = 0, up = 0;
    for (std::size_t j = 0; j < 5; ++j) {
        const real n = static_cast<real>(j + 1), image = std::exp(-2 * n * wave_.k * (std::max(y, -depth_) + depth_));
        const real size = flow_[j] * std::exp(n * wave_.k * y) / (1 + std::exp(-2 * n * wave_.k * depth_));
        along += size * (1 + image) * std::cos(n * theta);
        up += size * (1 - image) * std::sin(n * theta);
    }
    return {{along * wave_.heading[0], up, along * wave_.heading[1]}};
}

Motion Stokes::motion(real x, real z) const {
    const real angle = theta(x, z), y = height_at(angle);
    Motion m;
    m.moved[1] = y;
    m.velocity = velocity_at(angle, y);
    return m;
}

Vec<3> Stokes::velocity(const Vec<3>& at) const {
    const real angle = theta(at[0], at[2]);
    return velocity_at(angle, std::min(at[1], height_at(angle)));
}

}  // namespace weir::waves
