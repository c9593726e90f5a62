#include "tallcell/solver.hpp"

#include "core/error.hpp"
#include "free_surface/known_faces.hpp"
#include "mac/grid/closed_volume.hpp"
#include "mac/grid/inflow.hpp"
#include "mac/grid/rows.hpp"

namespace weir::tallcell {

/// One step of liquid on tall cells (Chentanez & Müller 2011, algorithm 1, in the order of mac_water). Before and after it the velocity is
/// known throughout the band of the level set, and divergence-free in the liquid to the tolerance of the pressure.
template <int D>
StepReport TallCells<D>::step(real dt) {
    if (!leapfrog_.started()) find_rate(dt);
    leapfrog_.advance(state_.u, dt);  // u at the middle of the step
    const real kick = leapfrog_.kick(dt, true);
    leapfrog_.keep(state_.u);
    refresh_velocity(dt);  // halo exchange in parallel, as deep as the motion
    place_solids(state_.time + dt);
    move_surface(dt);                               // Dφ/Dt = 0, and φ is a distance again
    control_volume();                               // only if the scene names it
    remesh();                                       // tall cells below the new surface
    advect(dt);                                     // Du/Dt = 0
    forces(kick);                                   // u += dt f
    const poisson::Report poisson = project(kick);  // u −= (dt/ρ) ∇p,  ∇·u = 0 on every cell of the lattice
    const real divergence = pressure_.max_divergence(state_);
    mac::require_room(state_, solids_, divergence, dt);
    extend_velocity();  // ∇u·∇φ = 0 beyond the liquid
    leapfrog_.finish(state_.u, kick);
    if (!std::isfinite(rate_)) throw NumericalFailure("velocity", "a velocity is no longer finite");
    state_.time += dt;
    ++steps_;
    return {.dt = dt,
            .cfl = dt * rate_,
            .max_divergence = divergence,
            .iterations = poisson.iterations,
            .residual_before = poisson.residual_before,
            .residual_after = poisson.residual_after,
            .residual_max = poisson.residual_max * state_.rho / kick};
}

/// Initial rate of change of the velocity: the result of a step of dt without motion.
template <int D>
void TallCells<D>::find_rate(real dt) {
    const BrushForcing account = brush_forcing_ ? *brush_forcing_ : BrushForcing();
    const MacVelocity<D> u = state_.u;
    leapfrog_.keep(state_.u);
    forces(dt);
    refresh(state_.u[D - 1], frame_.periodic(D - 1));
    pressure_.restrict_velocity(state_);
    pressure_.project(surface_.phi, state_, dt, solids_.moving());
    pressure_.spread(state_, dt);
    sync_periodic(state_.u, state_.sides);
    extend_velocity();
    leapfrog_.begin(state_.u, dt);
    state_.u = u;
    if (brush_forcing_) *brush_forcing_ = account;
}

template <int D>
void TallCells<D>::place_solids(real t) {
    if (!solids_.any() || (t > 0 && !solids_.moving())) return;
    solids_.place(state_, t);
    for_each_held(closed_, Index<D>{}, frame_.cells, [&](const Index<D>& I) { closed_(I) = state_.cells(I) == poisson::Cell::solid; });
    in_solids_.find(solids_, state_, frame_, steps_ == 0);
    surface_.set_closed(closed_, &in_solids_.closed());
    surface_.set_open_parts(solids_);
    if (t > 0) volume_.see_solids(surface_, state_);
}

template <int D>
void TallCells<D>::move_surface(real dt) {
    const auto timed = passes_.time("level set");
    volume_target_ -= volume_.advect(state_, surface_.phi, dt, steps_ % 2 == 1);
    surface_.advect(state_.u, dt, reach_);
    volume_.settle(surface_.phi, state_, closed_);
    volume_.correct(surface_, state_, closed_, volume_.courant(dt, rate_, norm(gravity_)));
    surface_.redistance();
    if (brush_forcing_) apply_brush_sources();
}

/// Unites the level set with the brush, or subtracts the brush. Poured liquid has the brush's velocity, drained liquid removes its own; the
/// volume is the change of the level set.
template <int D>
void TallCells<D>::apply_brush_sources() {
    const auto brush = brush_forcing_->at<D>(state_.time);
    const bool pours = brush.kind == BrushKind::pour;
    if (!pours && brush.kind != BrushKind::drain) return;
    const real before = surface_.volume();
    Vec<D> u{};  // mean over the cells that change sides
    real changed = 0;
    std::vector<std::pair<Index<D>, real>> part_before;  // cells that the brush may change, and their neighbours
    for (std::size_t cell = 0; cell < product(frame_.cells); ++cell) {
        const Index<D> I = frame_.index_of(cell);
        if ((closed_.empty() || !closed_(I)) && norm(frame_.centre(I) - brush.centre) < brush.radius + 3 * norm(frame_.h))
            part_before.emplace_back(I, surface_.fraction(I));
    }
    for (std::size_t cell = 0; cell < product(frame_.cells); ++cell) {
        const Index<D> I = frame_.index_of(cell);
        if (!closed_.empty() && closed_(I)) continue;
        real& phi = surface_.phi(I);
        const real inside = brush.radius - norm(frame_.centre(I) - brush.centre), was = phi;
        phi = pours ? std::min(phi, -inside) : std::max(phi, inside);
        if ((was < 0) == (phi < 0)) continue;
        changed += 1;
        for (int a = 0; a < D; ++a) {
            real &lower = state_.u[a](I), &upper = state_.u[a](I + e<D>(a));
            if (pours) lower = upper = brush.velocity[a];
            u[a] += 0.5 * (lower + upper);
        }
    }
    surface_.redistance();
    const real volume = surface_.volume() - before;
    volume_target_ += volume;
    for (const auto& [I, part] : part_before) volume_.add(I, surface_.fraction(I) - part);
    brush_forcing_->mass += state_.rho * volume;
    for (int a = 0; a < D && changed > 0; ++a) brush_forcing_->impulse[a] += state_.rho * volume * u[a] / changed;
}

template <int D>
void TallCells<D>::control_volume() {
    if (!options_.volume_control) return;
    const auto timed = passes_.time("effect volume_control");
    volume_shift_ += std::abs(surface_.regain(volume_target_ - surface_.volume()));
}

template <int D>
void TallCells<D>::remesh() {
    const auto timed = passes_.time("remesh");
    pressure_.set_surface(surface_, closed_, options_.shape, state_);
}

template <int D>
void TallCells<D>::advect(real dt) {
    const auto timed = passes_.time("advect");
    transport_(pressure_, surface_.phi, state_.sides, dt, rate_, state_.u, reach_);
}

template <int D>
void TallCells<D>::forces(real dt) {
    effects_.apply(Stage::force, state_, dt, passes_);
    const auto timed = passes_.time("walls");
    set_fixed_faces();
}

template <int D>
poisson::Report TallCells<D>::project(real dt) {
    const auto timed = passes_.time("project");
    refresh(state_.u[D - 1], frame_.periodic(D - 1));
    pressure_.restrict_velocity(state_);
    pressure_.change_runs(transport_.changes());
    const poisson::Report report =
        mac::explained_by_room(state_, solids_, [&] { return pressure_.project(surface_.phi, state_, dt, solids_.moving()); });
    pressure_.spread(state_, dt);
    sync_periodic(state_.u, state_.sides);
    return report;
}

template <int D>
void TallCells<D>::extend_velocity() {
    const auto timed = passes_.time("extrapolate");
    mark_liquid_faces();
    extrapolate_(state_.u, known_, surface_, in_solids_.faces(), surface_.layers() - 1);
    still_air<D>(state_.u, known_);
    in_solids_.constrain(state_.u, known_, frame_);
    sync_periodic(state_.u, state_.sides);
    rate_ = max_speed_rate();
}

/// Marks the faces updated by the pressure, as far as solids leave them open, and those prescribed by walls.
template <int D>
void TallCells<D>::mark_liquid_faces() {
    mark_faces_of_liquid<D>(state_, frame_, known_,
                            [&](int a, auto&& between, auto&& on_side) { for_each_face_run(frame_.cells, a, between, on_side); });
    in_solids_.forget(known_);
}

template <int D>
void TallCells<D>::set_fixed_faces() {
    sync_periodic(state_.u, state_.sides);
    set_side_faces(state_.u, state_.sides, state_.nu);
    solids_.set_faces(state_);
}

/// Rows wholly in runs are covered by the pressure's maximum.
template <int D>
real TallCells<D>::max_speed_rate() const {
    real rate = pressure_.fastest_run();
    for (int a = 0; a < D; ++a) {
        const auto& known = known_[static_cast<std::size_t>(a)];
        const auto& u = state_.u[a];
        Index<D> lo{}, hi = u.extent();
        lo[up_] = pressure_.fastest_run_below();
        const std::size_t x = static_cast<std::size_t>(lo[0]), count = static_cast<std::size_t>(hi[0]) - x;
        const int lines = hi[D - 1], rows = D == 3 ? hi[1] - lo[1] : 1, first_line = lo[D - 1];
        const real largest = plane_max(own(), lines, [&](int k) {
            if (k < first_line) return 0.0;
            real most = 0;
            for (int j = 0; j < rows; ++j) {
                Index<D> I = lo;
                I[1] = lo[1] + j, I[D - 1] = k;
                const std::size_t first = u.linear(I);
                most = mac::larger_or_nan(most, fastest_of_row(u.data() + first, known.data() + first, count));
            }
            return most;
        });
        if (std::isnan(largest)) return largest;
        rate = std::max(rate, largest * frame_.inv_h[a]);
    }
    return rate;
}

/// As on the uniform grid: CFL with the speed gained from gravity within the step, and the gravity wave of two cells (ω dt ≤ 1).
template <int D>
real TallCells<D>::advised_dt() const {
    const real h = frame_.h_min(), g = norm(gravity_);
    real dt = infinity;
    const real rate = std::max(rate_, solids_.max_rate(state_));
    if (rate > 0 || g > 0) dt = options_.cfl / (rate + std::sqrt(options_.cfl * g / h));
    if (g > 0) dt = std::min(dt, std::min(options_.cfl, 1.5) * std::sqrt(h / (pi * g)));
    return std::min(dt, effects_.max_dt(state_));
}

/// As advised_dt(), at the stability limit: the width of the surface's band, and ω dt = 2 for the shortest waves.
template <int D>
StepLimit TallCells<D>::stable_dt() const {
    const real h = frame_.h_min(), g = norm(gravity_), cells = 1 + std::ceil(options_.cfl);
    const real rate = std::max(rate_, solids_.max_rate(state_)), motion = rate + std::sqrt(cells * g / h);
    StepLimit limit;
    const auto at_most = [&](real dt, std::string_view why) {
        if (dt < limit.dt) limit = {dt, why};
    };
    if (motion > 0) at_most(cells / motion, "liquid or a body crosses more cells than the narrow band contains");
    if (g > 0) at_most(2 * std::sqrt(h / (pi * g)), "the phase of the gravity wave of two cells advances by two radians");
    return limit;
}

template class TallCells<2>;
template class TallCells<3>;

}  // namespace weir::tallcell
