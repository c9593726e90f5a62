#include "waves/dispersion.hpp"

#include <cmath>

namespace weir::waves {

real frequency(const Restoring& by, real k, real depth) {
    return std::sqrt((by.g * k + by.sigma_over_rho * k * k * k) * std::tanh(k * depth));
}

real group_speed(const Restoring& by, real k, real depth) {
    const real omega = frequency(by, k, depth), stiff = by.g * k + by.sigma_over_rho * k * k * k;
    const real t = std::tanh(k * depth), shallow = depth == infinity ? 0 : depth * (1 - t * t);
    return ((by.g + 3 * by.sigma_over_rho * k * k) * t + stiff * shallow) / (2 * omega);
}

real wavenumber(const Restoring& by, real omega, real depth) {
    real low = 0, high = by.g > 0 ? omega * omega / by.g : std::cbrt(omega * omega / by.sigma_over_rho);  // deep water
    while (frequency(by, high, depth) < omega) high *= 2;
    real k = high;
    for (int i = 0; i < 100; ++i) {
        const real excess = frequency(by, k, depth) - omega;
        (excess > 0 ? high : low) = k;
        real next = k - excess / group_speed(by, k, depth);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - k) <= 4e-16 * k) return next;
        k = next;
    }
    return k;
}

}  // namespace weir::waves
