// Friction, weight and pressure of one step as one system,
//
//     u = uⁿ + dt ν∇²u + dt f − (dt/ρ) ∇p,      ∇·u = 0,
//
// by turns: friction with a pressure p, then the pressure that makes the liquid free of divergence (van Kan 1986), F(p). Each turn ends so;
// what is not converged is an error of splitting. One is enough where dt ν/h² is small, or the last pressure is right; more are taken by
// Anderson's mixing, where the divergence d that friction leaves tells the pressure of a thick liquid, −2 ρ ν d (Cahouet & Chabard 1988):
// that the weak form balances a stress 2 ρν D(u) on the surface by p is what makes a thick liquid's slump right (Larionov et al. 2017).
#include "water/solver.hpp"

#include "staggered/inflow.hpp"

namespace weir::water {

using poisson::Cell;

namespace {

/// Of the velocity: what friction may not have seen of the pressure. The slump of a block is 5 times as exact.
constexpr real unseen_part = 0.01;

/// What the pressure's own tolerance leaves of the forces is not to be balanced, this many times over.
constexpr real of_tolerance = 100;

constexpr int most_turns = 20;

}  // namespace

/// On this rank's planes.
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

/// Before the forces.
template <int D>
void Water<D>::remember_velocity() {
    copy<D>(state_.u.face, friction_->before.face);
}

/// After the forces: u* = uⁿ + dt f + dt ν∇²(uⁿ + Δ). A thick liquid's surface is slow, so that the last pressure is right there, too.
template <int D>
void Water<D>::rub(real dt) {
    const auto timed = passes_.time("effect viscosity");
    StepOfFriction<D>& s = *friction_;
    for (int a = 0; a < D; ++a)
        for_each_cell(s.forces[a].extent(), [&](const Index<D>& I) { s.forces[a](I) = state_.u[a](I) - s.before[a](I); });
    if (heat_) heat_->slow(state_, dt);  // how far the faces of this step follow; the velocity itself is slowed before the pressure
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

/// dt a = dt f − (dt/ρ) ∇p of this step's pressure; where ice holds the liquid back, as much less.
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

/// Friction with s.felt; leaves the divergence of u + Δ in s.residual.
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

/// The pressure of the next turn, from F(p) of this one.
template <int D>
void Water<D>::mix_pressures() {
    StepOfFriction<D>& s = *friction_;
    const real thick = 2 * state_.rho * state_.nu * viscosity_->theta();
    for_each_cell(frame_.cells, [&](const Index<D>& I) { s.residual(I) = state_.p(I) - thick * s.residual(I) - s.p(I); });
    for_each_cell(frame_.cells, [&](const Index<D>& I) { state_.p(I) = s.p(I); });
    s.mixing.next(state_.p, s.residual, state_.cells);
    refresh(state_.p, frame_.periodic(D - 1));
}

/// Turns until friction has seen the pressure.
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
