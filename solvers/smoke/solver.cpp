// The step of solver "mac" (Bridson 2015, ch. 2), its limits and its report.
#include "smoke/solver.hpp"

#include "core/error.hpp"
#include "mac/grid/closed_volume.hpp"
#include "mac/grid/diagnostics.hpp"
#include "mac/grid/own_planes.hpp"

#include <algorithm>

namespace weir::smoke {

/// One step of the basic fluid algorithm (Bridson 2015, ch. 2), in one stage (semi-Lagrangian) or in the three stages of a Runge-Kutta
/// scheme. Before and after it, ∇·u = 0 to the projection's tolerance.
template <int D>
StepReport FlowSolver<D>::step(real dt) {
    whole_ = !own().distributed();
    real t = state_.time;
    apply(Stage::source, dt);  // emitters
    for (const Substep& stage : substeps(options_.scheme)) {
        const real part = stage.fraction() * dt;
        remember(dt);  // uⁿ, qⁿ with their ghosts
        if (walls_ && !walls_->found()) meet_walls(t, t);
        explicit_terms_before_advection(dt);  // u += dt f(uⁿ, qⁿ): all of it in flux form, half of it for MacCormack
        advect_fields(dt);                    // Dq/Dt = 0    only fields requested by an effect
        advect_velocity(dt);                  // Du/Dt = 0
        blend(stage);                         // γ and ζ of a Runge-Kutta stage
        apply(Stage::carried, part);          // (I − dt κ∇²) q = ...
        conduct(part);                        // ρ dH/dt = ∇·(k ∇T) + q     only where a substance is named
        explicit_terms_after_advection(dt);   // u += the rest of dt f(u, q)
        if (state_.no_slip_walls) move_no_slip_bodies(t + part, part);
        if (walls_ && solids_.moving()) meet_walls(t + part, t);
        apply(Stage::implicit, part);  // (I − dt ν∇²) u = ...
        if (walls_) walls_->enforce_no_slip(state_, part / state_.rho);
        move_solids(t += part, part);  // u·n = u_solid·n
        project(part);                 // ∇·u = 0
        enforce_sources();             // values prescribed by emitters and solids
    }
    apply(Stage::finish, dt);
    if (solids_.moving()) clear_solids();
    state_.time += dt;
    return report(dt);
}

template <int D>
void FlowSolver<D>::apply(Stage stage, real dt) {
    effects_.apply(stage, state_, dt, passes_);
}

/// In flux form all explicit rates use the fields before the step. The trapezoidal rule along trajectories applies half of each term at the
/// departure point: advected fields contain it.
template <int D>
void FlowSolver<D>::explicit_terms_before_advection(real dt) {
    refresh_fields();
    if (options_.scheme == Scheme::conservative) {
        apply_buoyancy(dt);
        return apply(Stage::force, dt);
    }
    if (options_.scheme != Scheme::maccormack) return;
    for (const Stage stage : {Stage::implicit, Stage::force, Stage::carried})
        effects_.apply_before_advection(stage, state_, 0.5 * dt, passes_);
    apply_buoyancy(0.5 * dt);
    if (!effects_.empty(Stage::implicit) || !effects_.empty(Stage::force) || (heat_ && heat_->has_buoyancy())) {
        sync_periodic(state_.u, state_.sides);
        solids_.set_faces(state_);  // forces do not change the velocity of solids
    }
    if (effects_.empty(Stage::carried)) return;
    const auto timed = passes_.time("ghosts");
    for (auto& field : state_.fields) field.enforce_sources();
    fill_field_planes();
    fill_end_planes(remembered_fields_, planes_to_extend());
    extend_fields();
}

/// Advected fields are final here: forces use the temperature at the end of the step.
template <int D>
void FlowSolver<D>::explicit_terms_after_advection(real dt) {
    if (options_.scheme == Scheme::conservative) return;
    const real part = options_.scheme == Scheme::maccormack ? 0.5 * dt : dt;
    refresh_fields();
    apply_buoyancy(part);
    apply(Stage::force, part);
    sync_periodic(state_.u, state_.sides);
}

template <int D>
void FlowSolver<D>::conduct(real dt) {
    if (!heat_) return;
    const auto timed = passes_.time("heat");
    heat_->conduct(state_, dt);
}

template <int D>
void FlowSolver<D>::apply_buoyancy(real dt) {
    if (heat_) heat_->apply_buoyancy(state_, dt);
}

/// Drag of ice reduces the response to pressure: sets the face coefficients of the matrix.
template <int D>
void FlowSolver<D>::apply_ice_drag(real dt) {
    if (!heat_) return;
    const auto timed = passes_.time("ice");
    if (heat_->apply_ice_drag(state_, dt)) projection_.set_matrix(state_);
}

template <int D>
void FlowSolver<D>::project(real dt) {
    apply_ice_drag(dt);
    const auto timed = passes_.time("project");
    report_ = &explained_by_room(state_, solids_,
                                 [&]() -> const poisson::Report& { return projection_.project(state_, dt, bodies_.get(), &solids_); });
    if (bodies_) solids_.see_velocities(state_);
    impulse_ += dt * (pressure_force(state_) + friction());
}

/// Emitted values are prescribed after each (sub)step: the next inflow from there does not depend on its length. Smoke is removed from
/// solids. For moving solids this is recorded once, at the end of the step.
template <int D>
void FlowSolver<D>::enforce_sources() {
    for (auto& field : state_.fields) field.enforce_sources();
    if (!solids_.moving()) clear_solids();
}

/// Maximum number of cells crossed per second, where `fluid` is the fluid's.
template <int D>
real FlowSolver<D>::rate(real fluid) const {
    const real h = *std::min_element(state_.u.h.begin(), state_.u.h.end());
    return std::isnan(fluid) ? fluid : std::max({fluid, side_rate_, solids_.max_rate(state_), bodies_ ? bodies_->bodies().max_rate(h) : 0});
}

/// The same after the last step, whose fastest flow is known.
template <int D>
real FlowSolver<D>::last_rate() const {
    return rate(std::isnan(fastest_) ? max_rate(state_.u) : fastest_);
}

template <int D>
StepReport FlowSolver<D>::report(real dt) {
    const real fastest = fastest_ = max_rate(state_.u);
    if (!std::isfinite(fastest)) throw NumericalFailure("velocity", "the velocity is not finite");
    if (own().distributed()) check_own_planes();
    const real divergence = max_divergence(state_);
    require_room(state_, solids_, divergence, dt);
    return {.dt = dt,
            .cfl = dt * fastest,
            .max_divergence = divergence,
            .iterations = report_->iterations,
            .residual_before = report_->residual_before,
            .residual_after = report_->residual_after,
            .residual_max = report_->residual_max / (state_.u.h[0] * state_.u.h[0])};
}

/// Checks that one process would make on whole fields after each step.
template <int D>
void FlowSolver<D>::check_own_planes() const {
    const auto check = [](const Grid<real, D>& q, const std::string& name) {
        if (!std::isfinite(max_magnitude(q))) throw NumericalFailure(name, name + " is no longer finite");
    };
    check(state_.p, "pressure");
    for (const auto& field : state_.fields) check(field.values, field.name);
}

template <int D>
void FlowSolver<D>::synchronize() {
    if (walls_ && state_.nu > 0 && !walls_->found()) walls_->find(state_, solids_, state_.time, state_.time);
    exchange_fields();
}

/// Ghost planes, or the planes of all ranks where whole fields are read.
template <int D>
void FlowSolver<D>::exchange_fields() {
    if (whole_) return;
    std::vector<Grid<real, D>*> shown;
    for (int a = 0; a < D; ++a) shown.push_back(&state_.u[a]);
    shown.push_back(&state_.p);
    for (auto& field : state_.fields) shown.push_back(&field.values);
    if (own().distributed_storage()) {
        shared_.clear();
        for (auto* grid : shown) shared_.push_back(planes_of(*grid));
        communicator().refresh(own().partition(), shared_, planes_beside, state_.sides.periodic(D - 1));
    } else {
        for (auto* grid : shown) gather(*grid);
    }
    whole_ = true;
}

template <int D>
real FlowSolver<D>::advised_dt() const {
    const real fastest = last_rate();
    return std::min({fastest > 0 ? cfl_ / fastest : infinity, effects_.max_dt(state_), heat_ ? heat_->max_dt(state_) : infinity});
}

/// Central fluxes are stable up to √3 cells per step; semi-Lagrangian schemes have no such limit.
template <int D>
StepLimit FlowSolver<D>::stable_dt() const {
    if (const real most = heat_ ? heat_->stable_dt(state_) : infinity; most < infinity)
        return {most, "explicit conduction of heat is stable up to it"};
    if (options_.scheme != Scheme::conservative) return {};
    const real fastest = last_rate();
    return {fastest > 0 ? runge_kutta_limit / fastest : infinity, runge_kutta_limit_why};
}

template class FlowSolver<2>;
template class FlowSolver<3>;

}  // namespace weir::smoke
