#include "particles/state/kernels.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace weir::particles {

const std::vector<std::string>& kernel_names() {
    static const std::vector<std::string> names{"poly6", "spiky", "viscosity", "cubic", "wendland"};
    return names;
}

KernelKind kernel_from_name(const std::string& name) {
    const auto& names = kernel_names();
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw std::logic_error("no kernel \"" + name + "\"");
    return static_cast<KernelKind>(at - names.begin());
}

namespace {

/// sigma of W = sigma f(q) / h^D: one over the integral of f over the unit ball.
template <int D>
real normalisation(KernelKind kind) {
    switch (kind) {
        case KernelKind::poly6:
            return D == 2 ? 4 / pi : 315 / (64 * pi);
        case KernelKind::spiky:
            return D == 2 ? 10 / pi : 15 / pi;
        case KernelKind::viscosity:
            return D == 2 ? 40 / pi : 15 / (2 * pi);
        case KernelKind::cubic:
            return D == 2 ? 40 / (7 * pi) : 8 / pi;
        case KernelKind::wendland:
            return D == 2 ? 7 / pi : 21 / (2 * pi);
    }
    return 0;
}

/// f(q), f'(q), and the D-dimensional Laplacian f'' + (D - 1) f' / q.
struct Profile {
    real f, df, laplacian;
};

template <int D>
Profile profile(KernelKind kind, real q) {
    const real u = 1 - q;
    switch (kind) {
        case KernelKind::poly6: {
            const real d = 1 - q * q;
            return {d * d * d, -6 * q * d * d, -6 * d * (D * d - 4 * q * q)};
        }
        case KernelKind::spiky:
            return {u * u * u, -3 * u * u, 6 * u - 3 * (D - 1) * u * u / q};
        case KernelKind::viscosity:
            if (D == 2) return {q * q / 4 - q * q * q / 9 - std::log(q) / 6 - 5.0 / 36, q / 2 - q * q / 3 - 1 / (6 * q), u};
            return {-q * q * q / 2 + q * q + 1 / (2 * q) - 1, -1.5 * q * q + 2 * q - 1 / (2 * q * q), 6 * u};
        case KernelKind::cubic:
            if (q <= 0.5) return {6 * (q * q * q - q * q) + 1, 6 * q * (3 * q - 2), 36 * q - 12 + (D - 1) * 6 * (3 * q - 2)};
            return {2 * u * u * u, -6 * u * u, 12 * u - 6 * (D - 1) * u * u / q};
        case KernelKind::wendland:
            return {u * u * u * u * (1 + 4 * q), -20 * q * u * u * u, 20 * u * u * ((D + 3) * q - D)};
    }
    return {};
}

/// Gauss-Legendre with five points on each of `pieces` intervals; breaks at the cubic spline's knot when pieces is even.
template <class F>
real integrate(real from, real to, int pieces, F&& f) {
    constexpr std::array<real, 5> x{0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640, 0.9061798459386640};
    constexpr std::array<real, 5> w{0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891, 0.2369268850561891};
    const real half = (to - from) / (2 * pieces);
    real sum = 0;
    for (int i = 0; i < pieces; ++i)
        for (std::size_t k = 0; k < x.size(); ++k) sum += w[k] * f(from + half * (2 * i + 1 + x[k]));
    return sum * half;
}

/// The integral over r in [from, h] where the integrand may have a kink at h/2 and starts like a square root (r = from + (b - from) u^2).
template <class F>
real integrate_radii(real from, real h, F&& f) {
    const auto part = [&](real a, real b) {
        return b > a ? integrate(0, 1, 48, [&](real u) { return 2 * u * (b - a) * f(a + (b - a) * u * u); }) : 0;
    };
    return part(from, std::max(from, h / 2)) + part(std::max(from, h / 2), h);
}

}  // namespace

template <int D>
Kernel<D>::Kernel(KernelKind kind, real support)
    : kind_(kind), h_(support), scale_(normalisation<D>(kind) / (D == 2 ? support * support : support * support * support)) {}

template <int D>
real Kernel<D>::value(real r) const {
    return r < h_ ? scale_ * profile<D>(kind_, r / h_).f : 0;
}
template <int D>
real Kernel<D>::derivative(real r) const {
    return r < h_ ? scale_ / h_ * profile<D>(kind_, r / h_).df : 0;
}
template <int D>
real Kernel<D>::laplacian(real r) const {
    return r < h_ ? scale_ / (h_ * h_) * profile<D>(kind_, r / h_).laplacian : 0;
}

template <int D>
real Kernel<D>::plane(real s) const {
    if (s >= h_) return 0;
    // 3D: rings of radius sqrt(r^2 - s^2) have area element 2 pi r dr. 2D: two points, y = sqrt(r^2 - s^2), dy = r dr / y.
    if (D == 3) return 2 * pi * integrate_radii(s, h_, [&](real r) { return value(r) * r; });
    if (s == 0) return 2 * integrate_radii(0, h_, [&](real r) { return value(r); });
    return 2 * integrate_radii(s, h_, [&](real r) { return value(r) * r / std::sqrt(r * r - s * s); });
}

template <int D>
real Kernel<D>::behind(real s) const {
    if (s >= h_) return 0;
    // 3D: the cap of the sphere of radius r beyond the plane has area 2 pi r (r - s). 2D: an arc of length 2 r acos(s / r).
    if (D == 3) return 2 * pi * integrate_radii(s, h_, [&](real r) { return value(r) * r * (r - s); });
    return 2 * integrate_radii(s, h_, [&](real r) { return value(r) * r * std::acos(std::min<real>(1, s / r)); });
}

template class Kernel<2>;
template class Kernel<3>;

}  // namespace weir::particles
