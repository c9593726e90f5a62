#include "particles/boundaries/walls.hpp"

namespace weir::particles {

namespace {

/// The Chebyshev series of f(u) / u^2 on [0, 1], from 64 Chebyshev nodes (discrete orthogonality).
template <class F>
WallSeries series(F&& f) {
    constexpr int nodes = 64;
    WallSeries c{};
    for (int i = 0; i < nodes; ++i) {
        const real angle = pi * (i + 0.5) / nodes, u = 0.5 + 0.5 * std::cos(angle), value = f(u) / (u * u);
        for (int k = 0; k < wall_terms; ++k) c[static_cast<std::size_t>(k)] += (k == 0 ? 1.0 : 2.0) / nodes * value * std::cos(k * angle);
    }
    return c;
}

}  // namespace

template <int D>
WallSeries behind_series(const Kernel<D>& kernel) {
    return series([&](real u) { return kernel.behind(kernel.support() * (1 - u)); });
}

template <int D>
WallSeries plane_series(const Kernel<D>& kernel) {
    return series([&](real u) { return kernel.plane(kernel.support() * (1 - u)); });
}

template WallSeries behind_series(const Kernel<2>&);
template WallSeries behind_series(const Kernel<3>&);
template WallSeries plane_series(const Kernel<2>&);
template WallSeries plane_series(const Kernel<3>&);

}  // namespace weir::particles
