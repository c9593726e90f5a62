#include "waves/spectra.hpp"

#include <cmath>

namespace weir::waves {

real Spectrum::of_frequency(real omega) const {
    if (kind == Kind::phillips) {
        const real k = wavenumber(by, omega, depth);
        return of_wavenumber(k) / group_speed(by, k, depth);
    }
    if (!(omega > 0)) return 0;
    const real r = peak / omega, tail = alpha * by.g * by.g * std::pow(omega, -5) * std::exp(-1.25 * r * r * r * r);
    if (kind == Kind::pierson_moskowitz || gamma == 1) return tail;
    const real width = omega > peak ? 0.09 : 0.07, off = (omega - peak) / (width * peak);
    return tail * std::pow(gamma, std::exp(-0.5 * off * off));
}

real Spectrum::of_wavenumber(real k) const {
    if (!(k > 0)) return 0;
    if (kind == Kind::phillips) return 0.5 * alpha / (k * k * k) * std::exp(-1 / (k * length * k * length));
    return of_frequency(frequency(by, k, depth)) * group_speed(by, k, depth);
}

/// Closed form for two of the three. For JONSWAP by the midpoint rule over u = (wp/w)^4, in which its tail is exp(-1.25 u): the omitted
/// ends contain less than 1e-9 of the variance.
real Spectrum::variance() const {
    if (kind == Kind::phillips) return 0.25 * alpha * length * length;
    const real plain = alpha * by.g * by.g / (5 * std::pow(peak, 4));
    if (kind == Kind::pierson_moskowitz || gamma == 1) return plain;
    constexpr int n = 20000;
    constexpr real end = 20;
    real sum = 0;
    for (int i = 0; i < n; ++i) {
        const real u = end * (i + 0.5) / n, ratio = std::pow(u, -0.25), width = ratio > 1 ? 0.09 : 0.07, off = (ratio - 1) / width;
        sum += std::exp(-1.25 * u) * std::pow(gamma, std::exp(-0.5 * off * off));
    }
    return 1.25 * plain * sum * end / n;
}

real Spectrum::peak_wavenumber() const { return wavenumber(by, peak, depth); }

/// With the constants of the paper; exp(-0.74 (g/(w U))^4) = exp(-1.25 (wp/w)^4) for wp = (0.74/1.25)^(1/4) g/U.
Spectrum pierson_moskowitz(const Restoring& by, real depth, real wind) {
    return {.kind = Spectrum::Kind::pierson_moskowitz,
            .by = by,
            .depth = depth,
            .alpha = 8.1e-3,
            .peak = std::pow(0.74 / 1.25, 0.25) * by.g / wind};
}

Spectrum jonswap(const Restoring& by, real depth, real wind, real fetch, real gamma) {
    return {.kind = Spectrum::Kind::jonswap,
            .by = by,
            .depth = depth,
            .alpha = 0.076 * std::pow(wind * wind / (fetch * by.g), 0.22),
            .peak = 22 * std::cbrt(by.g * by.g / (wind * fetch)),
            .gamma = gamma};
}

Spectrum phillips(const Restoring& by, real depth, real wind, real alpha) {
    Spectrum s{.kind = Spectrum::Kind::phillips, .by = by, .depth = depth, .alpha = alpha, .length = wind * wind / by.g};
    s.peak = frequency(by, std::sqrt(2.0 / 3) / s.length, depth);
    return s;
}

/// 1/N = integral of cos^2s(a/2) over a circle = 2 sqrt(pi) Gamma(s + 1/2) / Gamma(s + 1).
Spreading::Spreading(real s) : s_(s), scale_(std::exp(std::lgamma(s + 1) - std::lgamma(s + 0.5)) / (2 * std::sqrt(pi))) {}

}  // namespace weir::waves
