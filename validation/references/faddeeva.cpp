#include "validation/references/faddeeva.hpp"

#include <array>

namespace weir::validation {
namespace {

constexpr int terms = 40;  // Weideman's N: the coefficients have fallen to round-off

/// Coefficients a_1 .. a_N: Fourier coefficients of exp(-t^2)(L^2 + t^2) with t = L tan(theta/2)   (Weideman 1994, eq. 37 and table 1)
struct Expansion {
    real L = std::sqrt(terms / std::sqrt(2.0));
    std::array<real, terms> a{};
    Expansion() {
        constexpr int M = 2 * terms;
        for (int k = -M + 1; k < M; ++k) {
            const real theta = k * pi / M, t = L * std::tan(theta / 2);
            const real f = std::exp(-t * t) * (L * L + t * t);
            for (int n = 1; n <= terms; ++n) a[static_cast<std::size_t>(n - 1)] += f * std::cos(n * theta) / (2 * M);
        }
    }
};

Complex upper_half_plane(Complex z) {
    static const Expansion expansion;
    const Complex iz(-z.imag(), z.real());
    const Complex down = 1.0 / (expansion.L - iz), Z = (expansion.L + iz) * down;
    Complex p = 0;
    for (int n = terms; n-- > 0;) p = p * Z + expansion.a[static_cast<std::size_t>(n)];
    return 2.0 * p * down * down + down / std::sqrt(pi);
}

}  // namespace

Complex faddeeva(Complex z) { return z.imag() >= 0 ? upper_half_plane(z) : 2.0 * std::exp(-z * z) - upper_half_plane(-z); }

Complex scaled_erfc(Complex z) { return faddeeva(Complex(-z.imag(), z.real())); }

}  // namespace weir::validation
