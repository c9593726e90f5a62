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

#include "staggered/inflow.hpp"

namespace weir::water {

using poisson::Cell;

namespace {

/// Relative to the velocity: the splitting error that is accepted. The slump of a block is 5 times as accurate.
constexpr real unseen_part = 0.01;

/// Factor of the pressure's tolerance below which the forces need not be balanced.
constexpr real of_tolerance = 100;

constexpr int most_turns = 20;

}  // namespace

/// Copies this rank's planes.
template <int D>
static void copy(const std::array<Grid<real, D>, D>& from, std::array<Grid<real, D>, D>& to) {
    for (std::size_t a = 0; a < D; ++a) for_each_cell(from[a].extent(), [&](const Index<D>& I) { to[a](I) = from[a](I); });
}

template <int D>
StepOfFriction<D>::StepOfFriction(const MacState<D>& state)
    : before(state.u), forces(state.u), felt(state.u.face), p(state.extent()), residual(state.extent()), mixing(state.extent()) {}

template <int D>
std::size_t StepOfFriction<D>::bytes() const {
    std::size_t total = before.bytes() + forces.bytes() + p.bytes() + residual.bytes() + mixing.bytes();
    for (const auto& grid : felt) total += grid.bytes();
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
void Water<D>::rub(real dt) {
    const auto timed = passes_.time("effect viscosity");
    StepOfFriction<D>& s = *friction_;
    for (int a = 0; a < D; ++a)
        for_each_cell(s.forces[a].extent(), [&](const Index<D>& I) { s.forces[a](I) = state_.u[a](I) - s.before[a](I); });
    if (heat_) heat_->slow(state_, dt);  // the face coefficients of this step; the velocity itself is reduced before the projection
    copy<D>(s.before.face, state_.u.face);
    if (state_.grip) bodies_->grip(state_, solids_, dt);
    const bool thick = !bodies_ && dt * state_.nu > frame_.h_min() * frame_.h_min();
    if (thick) {
        copy<D>(s.forces.face, s.felt);
        pressure_.subtract(state_, surface_, dt, options_.sigma, options_.sigma > 0 ? &curvature_ : nullptr, s.felt);
    }
    viscosity_->apply(state_, surface_, closed_, dt, &s.forces, thick ? &s.felt : nullptr);
    for (int a = 0; a < D; ++a) for_each_cell(s.forces[a].extent(), [&](const Index<D>& I) { state_.u[a](I) += s.forces[a](I); });
    sync_periodic(state_.u, state_.sides);
}

/// dt a = dt f − (dt/ρ) ∇p with this step's pressure; reduced by the drag of ice.
template <int D>
void Water<D>::what_friction_feels(real dt) {
    StepOfFriction<D>& s = *friction_;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& mobility = state_.mobility[at];
        for_each_cell(s.felt[at].extent(),
                      [&](const Index<D>& I) { s.felt[at](I) = mobility.empty() ? s.forces[a](I) : mobility(I) * s.forces[a](I); });
    }
    pressure_.subtract(state_, surface_, dt, options_.sigma, options_.sigma > 0 ? &curvature_ : nullptr, s.felt);
    viscosity_->continue_felt(state_, s.felt);
}

/// Friction with s.felt; stores the divergence of u + Δ in s.residual.
template <int D>
void Water<D>::rub_again(real dt) {
    StepOfFriction<D>& s = *friction_;
    copy<D>(s.before.face, state_.u.face);
    viscosity_->apply_again(state_, s.felt, dt, state_.u.face);
    sync_periodic(state_.u, state_.sides);
    refresh(state_.u[D - 1], frame_.periodic(D - 1));
    for_each_line(frame_.cells,
                  [&](const Index<D>& I, std::size_t at) { flux_divergence_row(state_, I, frame_.cells[0], s.residual.data() + at); });
    for (int a = 0; a < D; ++a)
        for_each_cell(s.forces[a].extent(),
                      [&](const Index<D>& I) { state_.u[a](I) += s.forces[a](I) - viscosity_->felt()[static_cast<std::size_t>(a)](I); });
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
    for (s.turns = 0; s.turns < most_turns; ++s.turns) {
        {
            const auto timed = passes_.time("effect viscosity");
            what_friction_feels(kick);
            const real least = of_tolerance * options_.poisson.options.tolerance;
            if (viscosity_->unseen(state_, s.felt, kick, s.forces.face, least) <= unseen_part) return report;
            if (s.turns > 0) mix_pressures();
            for_each_cell(frame_.cells, [&](const Index<D>& I) { s.p(I) = state_.p(I); });
            if (s.turns > 0) what_friction_feels(kick);
            rub_again(kick);
        }
        if (heat_) heat_->slow(state_, kick);
        const int iterations = report.iterations;
        report = project_once(dt, kick, true);
        report.iterations += iterations;
    }
    return report;
}

#define WEIR_INSTANTIATE(D)                            \
    template struct StepOfFriction<D>;                 \
    template void Water<D>::remember_velocity();       \
    template void Water<D>::rub(real);                 \
    template void Water<D>::what_friction_feels(real); \
    template void Water<D>::mix_pressures();           \
    template void Water<D>::rub_again(real);           \
    template poisson::Report Water<D>::balance_friction(real, real, poisson::Report);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
