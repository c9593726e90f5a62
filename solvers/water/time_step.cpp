// Limits of the time step: speed of the liquid and of bodies, gravity and capillary waves of two cells (Brackbill, Kothe & Zemach 1992),
// emitters, viscosity.
#include "free_surface/known_faces.hpp"
#include "mac/grid/rows.hpp"
#include "water/solver.hpp"

namespace weir::water {

/// Over the faces updated by the pressure, and those prescribed by sides.
template <int D>
real Water<D>::max_speed_rate() const {
    real rate = 0;
    for (int a = 0; a < D; ++a) {
        const auto& known = known_[static_cast<std::size_t>(a)];
        const auto& u = state_.u[a];
        const Index<D>& n = known.extent();
        const real largest = plane_max(own(), n[D - 1], [&](int k) {
            real m = 0;
            const auto see = [&](std::size_t at, int faces) {
                m = mac::larger_or_nan(m, fastest_of_row(u.data() + at, known.data() + at, static_cast<std::size_t>(faces)));
            };
            Index<D> I{};
            I[D - 1] = k;
            const int rows = D == 2 ? 1 : n[1];
            for (int j = 0; j < rows; ++j) {
                if (D == 3) I[1] = j;
                const std::size_t row = u.linear(I);
                if (a > 0 && (I[a] == 0 || I[a] == frame_.cells[a])) {
                    see(row, n[0]);
                    continue;
                }
                const Segment extent = pressure_.faces_of_liquid(a, I);
                if (!extent.empty()) see(row + static_cast<std::size_t>(extent.begin), extent.end - extent.begin);
                if (a == 0) see(row, 1), see(row + static_cast<std::size_t>(frame_.cells[0]), 1);
            }
            return m;
        });
        if (std::isnan(largest)) return largest;
        rate = std::max(rate, largest * frame_.inv_h[a]);
    }
    return rate;
}

/// The smallest of these limits. CFL with the speed gained from gravity within the step. The gravity wave of two cells (ω dt ≤ 1; explicit
/// coupling of surface and pressure is stable up to 2). For thick liquids max(t/2, h²/ν), which resolves the start of the flow. The
/// capillary wave of two cells (Brackbill, Kothe & Zemach 1992: dt ≤ √(ρ h³ / (4π σ)) for one fluid).
template <int D>
real Water<D>::advised_dt() const {
    const real h = frame_.h_min(), g = norm(gravity_);
    real dt = infinity;
    const real rate =
        std::max({rate_, solids_.max_rate(state_), bodies_ ? bodies_->bodies().max_rate(h) : 0});  // a body may approach water at rest
    if (rate > 0 || g > 0) dt = options_.cfl / (rate + std::sqrt(options_.cfl * g / h));
    if (g > 0) dt = std::min(dt, std::sqrt(h / (pi * g)));
    if (options_.sigma > 0) dt = std::min(dt, std::sqrt(state_.rho * h * h * h / (4 * pi * options_.sigma)));
    for (const auto& emitter : emitters_)
        if (emitter.works(state_.time, state_.time + dt))
            for (int a = 0; a < D; ++a)
                if (emitter.velocity[a] != 0) dt = std::min(dt, options_.cfl * frame_.h[a] / std::abs(emitter.velocity[a]));
    if (viscosity_) dt = std::min(dt, std::max(0.5 * state_.time, h * h / state_.nu));
    if (heat_) dt = std::min(dt, heat_->max_dt(state_, surface_.area()));
    if (bodies_) dt = bodies_->time_to_land(state_, surface_.phi, surface_.cap(), rate_ * h, dt);
    return std::min(dt, effects_.max_dt(state_));
}

/// As advised_dt(), at the stability limit. Motion: two cells per step, the width of the hat function between markers and faces. Shortest
/// waves: ω dt = 2, since the surface moves with the previous velocity (gravity: ω² = g k, tension: ω² = σ k³/ρ, k = π/h).
template <int D>
StepLimit Water<D>::stable_dt() const {
    constexpr real cells = 2;
    const real h = frame_.h_min(), g = norm(gravity_);
    const real bodies = bodies_ ? bodies_->bodies().max_rate(h) : 0;
    const real rate = std::max({rate_, solids_.max_rate(state_), bodies}), motion = rate + std::sqrt(cells * g / h);
    StepLimit limit;
    const auto at_most = [&](real dt, std::string_view why) {
        if (dt < limit.dt) limit = {dt, why};
    };
    if (motion > 0) at_most(cells / motion, "liquid or a body crosses two cells");
    if (g > 0) at_most(2 * std::sqrt(h / (pi * g)), "the phase of the gravity wave of two cells advances by two radians");
    if (options_.sigma > 0)
        at_most(2 * std::sqrt(state_.rho * h * h * h / (pi * pi * pi * options_.sigma)),
                "the phase of the capillary wave of two cells advances by two radians");
    return limit;
}

#define WEIR_INSTANTIATE(D)                         \
    template real Water<D>::max_speed_rate() const; \
    template real Water<D>::advised_dt() const;     \
    template StepLimit Water<D>::stable_dt() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
