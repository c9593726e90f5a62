#include "waves/bed.hpp"

#include <cmath>

namespace weir::waves {

namespace {

std::size_t piece(const std::vector<real>& x, real where) {
    std::size_t i = 0;
    while (i + 2 < x.size() && where >= x[i + 1]) ++i;
    return i;
}

}  // namespace

real Bed::at(real where) const {
    if (where <= x.front()) return depth.front();
    if (where >= x.back()) return depth.back();
    const std::size_t i = piece(x, where);
    return depth[i] + (depth[i + 1] - depth[i]) * (where - x[i]) / (x[i + 1] - x[i]);
}

real Bed::slope(real where) const {
    if (where < x.front() || where > x.back()) return 0;
    const std::size_t i = piece(x, where);
    return (depth[i + 1] - depth[i]) / (x[i + 1] - x[i]);
}

/// Between nodes the phase is a cubic Hermite interpolant: its error, of fourth order in the node distance, is below 1e-9 of a turn.
Shoaled::Shoaled(const Bed& bed, const Restoring& by, real kx, real kz, real omega)
    : from_(bed.x.front()), step_((bed.x.back() - bed.x.front()) / 4096), kz_(kz), bed_(bed) {
    constexpr int nodes = 4096;
    const real sign = kx < 0 ? -1 : 1, k_deep = std::hypot(kx, kz);
    const real flux = group_speed(by, k_deep, infinity) * std::abs(kx) / k_deep;
    const auto along = [&](real x) {
        const real k = wavenumber(by, omega, bed.at(x));
        return sign * std::sqrt(std::max(0.0, k * k - kz * kz));
    };
    phase_.push_back(0);
    for (int i = 0; i <= nodes; ++i) {
        const real x = from_ + i * step_, k = wavenumber(by, omega, bed.at(x)), here = along(x);
        kx_.push_back(here);
        growth_.push_back(std::sqrt(flux / (group_speed(by, k, bed.at(x)) * std::abs(here) / k)));
        if (i == nodes) break;
        const real middle = x + 0.5 * step_, off = 0.5 * step_ * std::sqrt(0.6);  // Gauss quadrature, three points
        phase_.push_back(phase_.back() + step_ * (5 * along(middle - off) + 8 * along(middle) + 5 * along(middle + off)) / 18);
    }
}

Shoaled::Place Shoaled::at(real x) const {
    const real where = (x - from_) / step_, last = static_cast<real>(kx_.size() - 1);
    Place p{.depth = bed_.at(x)};
    if (where <= 0 || where >= last) {
        const std::size_t end = where <= 0 ? 0 : kx_.size() - 1;
        p.kx = kx_[end];
        p.phase = phase_[end] + p.kx * (x - (from_ + static_cast<real>(end) * step_));
        p.growth = growth_[end];
    } else {
        const auto i = static_cast<std::size_t>(where);
        const real s = where - static_cast<real>(i), rise = phase_[i + 1] - phase_[i], a = step_ * kx_[i], b = step_ * kx_[i + 1];
        const real c2 = 3 * rise - 2 * a - b, c3 = a + b - 2 * rise;
        p.phase = phase_[i] + s * (a + s * (c2 + s * c3));
        p.kx = (a + s * (2 * c2 + s * 3 * c3)) / step_;
        p.growth = growth_[i] + s * (growth_[i + 1] - growth_[i]);
    }
    p.k = std::hypot(p.kx, kz_);
    return p;
}

}  // namespace weir::waves
