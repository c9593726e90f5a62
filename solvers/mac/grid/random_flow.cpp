#include "mac/grid/random_flow.hpp"

namespace weir::mac {

namespace {

/// A number in [-1/2, 1/2) from a counter: the splitmix64 finaliser (Steele, Lea & Flood 2014); threads share no state.
real noise(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    x ^= x >> 31;
    return static_cast<real>(x >> 11) * 0x1p-53 - 0.5;
}

}  // namespace

template <int D>
void set_random_flow(MacVelocity<D>& u, real speed, std::uint64_t seed) {
    const real amplitude = speed * u.h[0];
    const auto potential = [&](int component, Index<D> I) {
        std::uint64_t at = static_cast<std::uint64_t>(component);
        for (int d = 0; d < D; ++d)
            at = at * static_cast<std::uint64_t>(u.cells[d]) + static_cast<std::uint64_t>((I[d] + u.cells[d]) % u.cells[d]);
        return amplitude * noise(seed * 0x2545f4914f6cdd1dULL + at);
    };
    for (int a = 0; a < D; ++a) {
        const int b = (a + 1) % D;
        for_each_cell(u[a].extent(), [&](const Index<D>& I) {
            if constexpr (D == 2) {  // u = ∂ψ/∂y, v = −∂ψ/∂x
                const real difference = (potential(0, I + e<D>(b)) - potential(0, I)) / u.h[b];
                u[a](I) = a == 0 ? difference : -difference;
            } else {
                const int c = (a + 2) % D;
                u[a](I) = (potential(c, I + e<D>(b)) - potential(c, I)) / u.h[b] - (potential(b, I + e<D>(c)) - potential(b, I)) / u.h[c];
            }
        });
    }
}

template void set_random_flow(MacVelocity<2>&, real, std::uint64_t);
template void set_random_flow(MacVelocity<3>&, real, std::uint64_t);

}  // namespace weir::mac
