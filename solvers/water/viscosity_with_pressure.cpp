// The explicit change of the velocity that friction uses, dt a: from the last pressure, or from that of the same step (viscosity.hpp).
#include "water/viscosity.hpp"

#include <cmath>
#include <limits>

namespace weir::water {

using poisson::Cell;

/// Reduction of the residual in a repeated solve of the same step.
static constexpr real further = 1e-3;

/// Moves to the next face of axis a along d; false at a side.
template <int D>
bool SurfaceViscosity<D>::step(int a, Index<D>& I, int d, int by) const {
    I[d] += by;
    if (frame_.periodic(d)) I[d] = (I[d] + frame_.cells[d]) % frame_.cells[d];
    return I[d] >= 0 && I[d] < mass_[static_cast<std::size_t>(a)].extent()[d];
}

/// `with_pressure` is known where p_ is 1; the other faces get the mean of their known neighbours, two layers deep.
template <int D>
void SurfaceViscosity<D>::continue_to_surface(Faces& with_pressure) {
    constexpr real none = std::numeric_limits<real>::quiet_NaN();
    for (int layer = 0; layer < 2; ++layer) {
        refresh_faces<D>(p_, frame_, 1);
        refresh_faces<D>(with_pressure, frame_, 1);
        for_each_unknown([&](int a, const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            real sum = 0;
            int count = 0;
            for (int d = 0; d < D && p_[at](I) == 0; ++d)
                for (const int by : {-1, 1})
                    if (Index<D> J = I; step(a, J, d, by) && p_[at](J) > 0) sum += with_pressure[at](J), ++count;
            ap_[at](I) = count > 0 ? sum / count : none;
        });
        for_each_unknown([&](int a, const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            if (!std::isnan(ap_[at](I))) with_pressure[at](I) = ap_[at](I), p_[at](I) = 1;
        });
    }
}

/// Known from the last pressure between cells that were liquid then and are now; beside bodies only deep in the liquid.
template <int D>
void SurfaceViscosity<D>::predict_from_pressure(const MacState<D>& state, const LevelSet<D>& surface, real dt, const MacVelocity<D>& forces,
                                                const Faces* at_surface) {
    const real deep = -1.5 * frame_.h_max();
    const auto is_known = [&](const Index<D>& I) {
        return state.cells(I) == Cell::fluid && (bodies_ ? surface.phi(I) < deep : state.p(I) != 0);
    };
    for_each_unknown([&](int a, const Index<D>& I) {
        const auto at = static_cast<std::size_t>(a);
        const Index<D> below = frame_.near(I, a, -1), above = frame_.near(I, a, 0);
        const bool under = is_known(below), over = is_known(above);
        const bool cut = at_surface && ((under && state.cells(above) == Cell::air) || (over && state.cells(below) == Cell::air));
        const real follows = state.mobility[at].empty() ? 1 : state.mobility[at](I);
        p_[at](I) = cut || (under && over) ? 1 : 0;
        if (cut)
            with_pressure_[at](I) = follows * (*at_surface)[at](I);
        else if (under && over)
            with_pressure_[at](I) = follows * (forces[a](I) - dt / state.rho * (state.p(above) - state.p(below)) * frame_.inv_h[a]);
    });
    if (!bodies_) continue_to_surface(with_pressure_);
}

template <int D>
void SurfaceViscosity<D>::apply_again(const MacState<D>& state, const Faces& with_pressure, real dt, Faces& u) {
    for_each_unknown([&](int a, const Index<D>& I) {
        const auto at = static_cast<std::size_t>(a);
        r_[at](I) += mass_[at](I) * (with_pressure[at](I) - with_pressure_[at](I));
        with_pressure_[at](I) = with_pressure[at](I);
    });
    solve(state, dt * state.nu, further);
    for_each_unknown([&](int a, const Index<D>& I) { u[static_cast<std::size_t>(a)](I) += x_[static_cast<std::size_t>(a)](I); });
}

template <int D>
void SurfaceViscosity<D>::continue_with_pressure(const MacState<D>& state, Faces& with_pressure) {
    for_each_unknown([&](int a, const Index<D>& I) {
        const auto at = static_cast<std::size_t>(a);
        const bool known = state.cells(frame_.near(I, a, -1)) == Cell::fluid || state.cells(frame_.near(I, a, 0)) == Cell::fluid;
        p_[at](I) = known ? 1 : 0;
    });
    continue_to_surface(with_pressure);
}

/// With R = (M + s K)⁻¹ M and 0 ≤ R ≤ 1, ‖(1 − R) e‖² ≤ e·(1 − R) e ≤ min(e·e, s e·K e), in M.
template <int D>
real SurfaceViscosity<D>::unseen(const MacState<D>& state, const Faces& with_pressure, real dt, const Faces& forces, real least) {
    const auto square = [&](const Faces& q) {
        for_each_unknown([&](int a, const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            ap_[at](I) = std::max(mass_[at](I), real{0}) * q[at](I);
        });
        return dot(q, ap_);
    };
    const real size = std::sqrt(square(state.u.face)) + least * std::sqrt(square(forces));
    for_each_unknown([&](int a, const Index<D>& I) {
        const auto at = static_cast<std::size_t>(a);
        p_[at](I) = with_pressure[at](I) - with_pressure_[at](I);
    });
    const real all = square(p_);
    refresh_faces<D>(p_, frame_, 1);
    for_each_unknown([&](int a, const Index<D>& I) { ap_[static_cast<std::size_t>(a)](I) = stress_divergence(p_, a, I, 0); });
    const real bound = std::sqrt(std::min(all, theta_ * dt * state.nu * dot(p_, ap_)));
    return size > 0 ? bound / size : 0;
}

#define WEIR_INSTANTIATE(D)                                                                                                       \
    template void SurfaceViscosity<D>::predict_from_pressure(const MacState<D>&, const LevelSet<D>&, real, const MacVelocity<D>&, \
                                                             const Faces*);                                                       \
    template void SurfaceViscosity<D>::continue_to_surface(Faces&);                                                               \
    template void SurfaceViscosity<D>::apply_again(const MacState<D>&, const Faces&, real, Faces&);                               \
    template void SurfaceViscosity<D>::continue_with_pressure(const MacState<D>&, Faces&);                                        \
    template real SurfaceViscosity<D>::unseen(const MacState<D>&, const Faces&, real, const Faces&, real);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
