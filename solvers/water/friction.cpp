// Coupling of friction, weight and pressure in one step,
//
//     u = uⁿ + dt ν∇²u + dt f − (dt/ρ) ∇p,      ∇·u = 0,
//
// by partitioned iterations: friction with a given pressure p, then the projection (van Kan 1986), F(p). Every iteration ends with the
// projection; what is not converged is a splitting error. One iteration suffices where dt ν/h² is small or the last pressure is accurate.
// More iterations use Anderson mixing, where the divergence d after friction gives the pressure correction of a thick liquid, −2 ρ ν d
// (Cahouet & Chabard 1988). In the weak form p balances the stress 2 ρν D(u) on the surface, which is required for the slump of thick
// liquids (Larionov et al. 2017).
#include "water/solver.hpp"

#include "mac/grid/inflow.hpp"

namespace weir::water {

using poisson::Cell;

namespace {

/// Relative to the velocity: the splitting error that is accepted. The slump of a block is 5 times as accurate.
constexpr real unseen_part = 0.01;

/// Factor of the pressure's tolerance below which the forces need not be balanced.
constexpr real of_tolerance = 100;

constexpr int most_friction_iterations = 20;

}  // namespace

/// Copies this rank's planes.
template <int D>
static void copy(const std::array<Grid<real, D>, D>& from, std::array<Grid<real, D>, D>& to) {
    for (std::size_t a = 0; a < D; ++a) for_each_cell(from[a].extent(), [&](const Index<D>& I) { to[a](I) = from[a](I); });
}

template <int D>
StepOfFriction<D>::StepOfFriction(const MacState<D>& state)
    : before(state.u), forces(state.u), with_pressure(state.u.face), p(state.extent()), residual(state.extent()), mixing(state.extent()) {}

template <int D>
std::size_t StepOfFriction<D>::bytes() const {
    std::size_t total = before.bytes() + forces.bytes() + p.bytes() + residual.bytes() + mixing.bytes();
    for (const auto& grid : with_pressure) total += grid.bytes();
    return total;
}

/// Called before the forces.
template <int D>
void Water<D>::remember_velocity() {
    copy<D>(state_.u.face, friction_->before.face);
}

/// Called after the forces: u* = uⁿ + dt f + dt ν∇²(uⁿ + Δ). A thick liquid's surface moves slowly, so the last pressure is accurate there,
/// too.
template <int D>
void Water<D>::apply_viscosity(real dt) {
    const auto timed = passes_.time("effect viscosity");
    StepOfFriction<D>& s = *friction_;
    for (int a = 0; a < D; ++a)
        for_each_cell(s.forces[a].extent(), [&](const Index<D>& I) { s.forces[a](I) = state_.u[a](I) - s.before[a](I); });
    if (heat_)
        heat_->apply_ice_drag(state_, dt);  // the face coefficients of this step; the velocity itself is reduced before the projection
    copy<D>(s.before.face, state_.u.face);
    if (state_.no_slip_walls) bodies_->set_no_slip_walls(state_, solids_, dt);
    const bool thick = !bodies_ && dt * state_.nu > frame_.h_min() * frame_.h_min();
    if (thick) {
        copy<D>(s.forces.face, s.with_pressure);
        pressure_.subtract(state_, surface_, dt, options_.sigma, options_.sigma > 0 ? &curvature_ : nullptr, s.with_pressure);
    }
    viscosity_->apply(state_, surface_, closed_, dt, &s.forces, thick ? &s.with_pressure : nullptr);
    for (int a = 0; a < D; ++a) for_each_cell(s.forces[a].extent(), [&](const Index<D>& I) { state_.u[a](I) += s.forces[a](I); });
    sync_periodic(state_.u, state_.sides);
}

/// dt a = dt f − (dt/ρ) ∇p with this step's pressure; reduced by the drag of ice.
template <int D>
void Water<D>::velocity_with_pressure(real dt) {
    StepOfFriction<D>& s = *friction_;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& mobility = state_.mobility[at];
        for_each_cell(s.with_pressure[at].extent(), [&](const Index<D>& I) {
            s.with_pressure[at](I) = mobility.empty() ? s.forces[a](I) : mobility(I) * s.forces[a](I);
        });
    }
    pressure_.subtract(state_, surface_, dt, options_.sigma, options_.sigma > 0 ? &curvature_ : nullptr, s.with_pressure);
    viscosity_->continue_with_pressure(state_, s.with_pressure);
}

/// Friction with s.with_pressure; stores the divergence of u + Δ in s.residual.
template <int D>
void Water<D>::repeat_viscosity(real dt) {
    StepOfFriction<D>& s = *friction_;
    copy<D>(s.before.face, state_.u.face);
    viscosity_->apply_again(state_, s.with_pressure, dt, state_.u.face);
    sync_periodic(state_.u, state_.sides);
    refresh(state_.u[D - 1], frame_.periodic(D - 1));
    for_each_line(frame_.cells,
                  [&](const Index<D>& I, std::size_t at) { flux_divergence_row(state_, I, frame_.cells[0], s.residual.data() + at); });
    for (int a = 0; a < D; ++a)
        for_each_cell(s.forces[a].extent(), [&](const Index<D>& I) {
            state_.u[a](I) += s.forces[a](I) - viscosity_->with_pressure()[static_cast<std::size_t>(a)](I);
        });
    set_fixed_faces();
}

/// The pressure of the next iteration, from F(p) of this one.
template <int D>
void Water<D>::mix_pressures() {
    StepOfFriction<D>& s = *friction_;
    const real thick = 2 * state_.rho * state_.nu * viscosity_->theta();
    for_each_cell(frame_.cells, [&](const Index<D>& I) { s.residual(I) = state_.p(I) - thick * s.residual(I) - s.p(I); });
    for_each_cell(frame_.cells, [&](const Index<D>& I) { state_.p(I) = s.p(I); });
    s.mixing.next(state_.p, s.residual, state_.cells);
    refresh(state_.p, frame_.periodic(D - 1));
}

/// Iterates until the splitting error of friction is small.
template <int D>
poisson::Report Water<D>::balance_friction(real dt, real kick, poisson::Report report) {
    StepOfFriction<D>& s = *friction_;
    s.mixing.restart();
    for (s.iterations = 0; s.iterations < most_friction_iterations; ++s.iterations) {
        {
            const auto timed = passes_.time("effect viscosity");
            velocity_with_pressure(kick);
            const real least = of_tolerance * options_.poisson.options.tolerance;
            if (viscosity_->unseen(state_, s.with_pressure, kick, s.forces.face, least) <= unseen_part) return report;
            if (s.iterations > 0) mix_pressures();
            for_each_cell(frame_.cells, [&](const Index<D>& I) { s.p(I) = state_.p(I); });
            if (s.iterations > 0) velocity_with_pressure(kick);
            repeat_viscosity(kick);
        }
        if (heat_) heat_->apply_ice_drag(state_, kick);
        const int iterations = report.iterations;
        report = project_once(dt, kick, true);
        report.iterations += iterations;
    }
    return report;
}

#define WEIR_INSTANTIATE(D)                               \
    template struct StepOfFriction<D>;                    \
    template void Water<D>::remember_velocity();          \
    template void Water<D>::apply_viscosity(real);        \
    template void Water<D>::velocity_with_pressure(real); \
    template void Water<D>::mix_pressures();              \
    template void Water<D>::repeat_viscosity(real);       \
    template poisson::Report Water<D>::balance_friction(real, real, poisson::Report);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
