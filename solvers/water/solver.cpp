// The step of solver "mac_water": markers and cells with a level set (Foster & Fedkiw 2001; Zhu & Bridson 2005).
#include "water/solver.hpp"

#include "core/parallel.hpp"
#include "free_surface/known_faces.hpp"
#include "mac/grid/closed_volume.hpp"
#include "mac/grid/inflow.hpp"
#include "water/curvature.hpp"

namespace weir::water {

/// One step of the marker-and-cell method with a free surface. Before and after it the velocity is known throughout the band of the level
/// set, and divergence-free in the liquid to the tolerance of the pressure.
template <int D>
StepReport Water<D>::step(real dt) {
    const real kick = to_middle(dt);
    refresh_velocity(dt);
    move_bodies(dt);
    move_solids(state_.time + dt);
    move_surface(dt);                                   // Dx/Dt = u for markers, Dφ/Dt = 0
    apply_sources_and_sinks(dt);                        // emitters, open sides
    redistribute_markers();                             // keeps the number of markers per cell in bounds
    correct_surface(dt);                                // particle level-set correction, redistancing
    conduct(dt);                                        // ρ dH/dt = ∇·(k ∇T) + q     only where a substance is named
    momentum_to_faces(dt);                              // u* from the markers, or D u/Dt = 0 on the grid
    forces(kick);                                       // u* += dt f, (I − dt ν∇²) u* = ...
    const poisson::Report poisson = project(dt, kick);  // u = u* − (dt/ρ) ∇p,  ∇·u = 0,  p = σ κ on the surface
    pressure_.keep_gas_velocity(state_);
    const real divergence = pressure_.max_divergence(state_);
    mac::require_room(state_, solids_, divergence, dt);
    extend_velocity(dt);  // ∇u·∇φ = 0 beyond the liquid
    momentum_to_markers(dt);
    leapfrog_.finish(state_.u, kick);
    state_.time += dt;
    ++steps_;
    if (own().distributed()) check_own();
    return {.dt = dt,
            .cfl = dt * rate_,
            .max_divergence = divergence,
            .iterations = poisson.iterations,
            .residual_before = poisson.residual_before,
            .residual_after = poisson.residual_after,
            .residual_max = poisson.residual_max / (state_.u.h[0] * state_.u.h[0]) * (kick / dt),
            .viscous_iterations = viscosity_ ? viscosity_->iterations() : 0,
            .viscous_coupling_iterations = friction_ ? friction_->iterations : 0};
}

/// Advances the velocity to the middle of this step. Returns the duration of the forces.
template <int D>
real Water<D>::to_middle(real dt) {
    const auto works = [&](const Emitter<D>& emitter) { return emitter.works(state_.time, state_.time + dt); };
    if (bodies_ || std::any_of(emitters_.begin(), emitters_.end(), works)) return leapfrog_.whole_kick(dt);
    if (!leapfrog_.started()) find_rate(dt);
    leapfrog_.advance(state_.u, dt);
    return leapfrog_.kick(dt, options_.transfer == Transfer::grid);
}

/// Initial rate of change of the velocity: the result of a step of dt without motion. The record of interactive forcing is restored.
template <int D>
void Water<D>::find_rate(real dt) {
    const BrushForcing account = brush_forcing_ ? *brush_forcing_ : BrushForcing();
    for (int a = 0; a < D; ++a) before_[a] = state_.u[a];
    leapfrog_.keep(state_.u);
    forces(dt);
    project(dt, dt);
    extend_velocity(dt);
    leapfrog_.begin(state_.u, dt);
    for (int a = 0; a < D; ++a) state_.u[a] = before_[a];
    if (brush_forcing_) *brush_forcing_ = account;
}

template <int D>
void Water<D>::move_bodies(real dt) {
    if (!bodies_) return;
    const auto timed = passes_.time("bodies");
    if (state_.no_slip_walls) bodies_->continue_pressure(state_);
    bodies_->advance_free(solids_, dt);
}

template <int D>
void Water<D>::move_solids(real t) {
    if (!solids_.moving()) return;
    const auto timed = passes_.time("solids");
    place_solids(t);
}

template <int D>
void Water<D>::place_solids(real t) {
    if (!solids_.any() || (t > 0 && !solids_.moving())) return;
    solids_.place(state_, t);
    mark_closed();
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        for (std::size_t i = at; i < at + static_cast<std::size_t>(frame_.cells[0]); ++i)
            state_.cells[i] = closed_[i] ? poisson::Cell::solid : poisson::Cell::fluid;
    });
    in_solids_.find(solids_, state_, frame_, steps_ == 0);
    surface_.set_closed(closed_, &in_solids_.closed());
    surface_.set_open_parts(solids_);
    if (t > 0) volume_.see_solids(surface_, state_);
}

/// Called after solids were placed.
template <int D>
void Water<D>::mark_closed() {
    for (const CellBox<D>& box : solids_.changed())
        for_each_held(closed_, box.lo, box.hi, [&](const Index<D>& I) { closed_(I) = state_.cells(I) == poisson::Cell::solid; });
    mark_near_solids(solids_, frame_, near_solid_);
}

template <int D>
void Water<D>::move_surface(real dt) {
    const auto timed = passes_.time("move surface");
    move_markers(markers_, state_.u, frame_, dt, options_.trace, state_.sides, solids_.solids(), near_solid_);
    if (heat_) heat_->carry(state_, surface_, dt, options_.trace);
    if (keeps_volume_) volume_target_ -= volume_.advect(state_, surface_.phi, dt, steps_ % 2 == 1);
    surface_.advect(state_.u, dt, reach_);
}

template <int D>
void Water<D>::correct_surface(real dt) {
    {
        const auto timed = passes_.time("level set");
        const auto& exempt = not_solved_for(dt);
        if (keeps_volume_) volume_.settle(surface_.phi, state_, exempt);
        escaped_ += static_cast<std::int64_t>(surface_.correct_with_particles(markers_, keeps_volume_ ? &volume_.part() : nullptr));
        if (keeps_volume_) volume_.correct(surface_, state_, exempt, volume_.courant(dt, rate_, norm(gravity_)));
        surface_.redistance();
    }
    evaporate(dt);
    control_volume();
    curvature();
    const auto timed = passes_.time("level set");
    pressure_.set_surface(surface_, not_solved_for(dt), state_);
}

/// Lowers the surface by the evaporated volume, uniformly. The volume recorded is the change of the level set; markers now outside are
/// removed.
template <int D>
void Water<D>::evaporate(real dt) {
    if (!heat_) return;
    const real area = surface_.area(), wanted = heat_->evaporates(state_, area, dt);
    if (wanted == 0 || area == 0) return;
    const auto timed = passes_.time("evaporate");
    const real before = surface_.volume();
    surface_.dilate(-wanted / area);
    volume_.follow(surface_, state_, -wanted / area);
    const real lost = before - surface_.volume();
    heat_->leaves(state_, lost, volume_target_);
    volume_target_ -= lost;
    if (lost < 0) return;
    markers_.retain([&](std::size_t p) { return surface_.at(markers_.position(p)) < 0; });
    markers_.sort(frame_);
}

template <int D>
void Water<D>::conduct(real dt) {
    if (!heat_) return;
    const auto timed = passes_.time("heat");
    heat_->conduct(state_, volume_target_, surface_.area(), dt);
}

/// Drag of ice reduces the response of the velocity to pressure.
template <int D>
void Water<D>::apply_ice_drag(real dt) {
    if (!heat_) return;
    const auto timed = passes_.time("ice");
    if (heat_->apply_ice_drag(state_, dt)) pressure_.apply_drag(state_);
}

template <int D>
void Water<D>::momentum_to_faces(real dt) {
    const auto timed = passes_.time("markers to faces");
    if (options_.transfer == Transfer::grid)
        advect_faces(dt);
    else
        markers_to_faces(markers_, frame_, sums_, state_.u, known_);
    set_fixed_faces();
    impose_emitters(dt, &Emitter<D>::Face::moves);
    in_solids_.forget(known_);
    extrapolate_(state_.u, known_, surface_, in_solids_.faces(), 2);  // liquid cells without a marker, faces at the edge
    if (keeps_volume_) still_air<D>(state_.u, known_);
    if (options_.transfer == Transfer::flip) {
        // With bodies, FLIP's difference is taken relative to the liquid's own velocity. Relative to the body's, the impulse that stops a
        // falling body would be given to the markers there. extend_velocity() completes before_. It also reads faces without a marker
        // nearby, so before_ must be set everywhere in this step: checkpoints do not contain older values.
        for (int a = 0; bodies_ && a < D; ++a) before_[a] = state_.u[a];
        in_solids_.constrain(state_.u, known_, frame_);
        sync_periodic(state_.u, state_.sides);
        if (!bodies_) copy_faces_near(markers_, frame_, state_.u, before_);
    } else {
        sync_periodic(state_.u, state_.sides);
    }
    leapfrog_.keep(state_.u, known_);
}

/// Friction uses the last pressure in addition to the forces, so that liquid at rest has no friction; project() iterates to the new
/// pressure.
template <int D>
void Water<D>::forces(real dt) {
    if (viscosity_) remember_velocity();
    effects_.apply(Stage::force, state_, dt, passes_);
    {
        const auto timed = passes_.time("walls");
        set_fixed_faces();
    }
    if (viscosity_) apply_viscosity(dt);
}

template <int D>
poisson::Report Water<D>::project_once(real dt, real kick, bool again) {
    const auto timed = passes_.time("project");
    impose_emitters(dt, &Emitter<D>::Face::emits);
    const Grid<real, D>* curvature = options_.sigma > 0 ? &curvature_ : nullptr;
    if (again) return pressure_.project_again(state_, surface_, kick, options_.sigma, curvature);
    return pressure_.project(state_, surface_, kick, options_.sigma, curvature, bodies_.get(), &solids_);
}

template <int D>
poisson::Report Water<D>::project(real dt, real kick) {
    apply_ice_drag(kick);
    poisson::Report report = mac::explained_by_room(state_, solids_, [&] { return project_once(dt, kick, false); });
    if (viscosity_ && !bodies_) report = balance_friction(dt, kick, report);
    if (bodies_) in_solids_.see_velocities(solids_.solids(), state_);
    refresh(state_.u[D - 1], frame_.periodic(D - 1));
    return report;
}

template <int D>
void Water<D>::extend_velocity(real dt) {
    const auto timed = passes_.time("extrapolate");
    mark_liquid_faces();
    impose_emitters(dt, &Emitter<D>::Face::moves);
    extrapolate_(state_.u, known_, surface_, in_solids_.faces(), surface_.layers() - 1);
    // With bodies, FLIP's difference uses the liquid's velocity before forces, constrained by the body's present velocity.
    if (bodies_ && options_.transfer == Transfer::flip) in_solids_.constrain(before_, known_, frame_);
    in_solids_.constrain(state_.u, known_, frame_);
    sync_periodic(state_.u, state_.sides);
    rate_ = max_speed_rate();
}

template <int D>
void Water<D>::momentum_to_markers(real dt) {
    const auto timed = passes_.time("faces to markers");
    if (options_.transfer == Transfer::pic || options_.transfer == Transfer::apic) refresh_faces(state_.u, frame_, 1);
    switch (options_.transfer) {
        case Transfer::grid:
            return;
        case Transfer::pic:
            pic_to_markers(state_.u, frame_, markers_);
            break;
        case Transfer::flip:
            flip_to_markers(state_.u, before_, options_.flip_blend, frame_, markers_);
            break;
        case Transfer::apic:
            apic_to_markers(state_.u, frame_, markers_);
            break;
    }
    carry_emitters_velocity(dt);
}

/// Du/Dt = 0 by semi-Lagrangian advection (Stam 1999), on all faces near the liquid; known_ marks them.
template <int D>
void Water<D>::advect_faces(real dt) {
    for (int a = 0; a < D; ++a) before_[a] = state_.u[a];
    const real near = 2 * frame_.h_min();
    for (int a = 0; a < D; ++a)
        for_each_cell(state_.u[a].extent(), [&](const Index<D>& I) {
            const real phi = std::min(surface_.phi(frame_.near(I, a, -1)), surface_.phi(frame_.near(I, a, 0)));
            auto& known = known_[static_cast<std::size_t>(a)](I);
            known = phi < near;
            if (!known) return;
            const Vec<D> from = trace(before_, frame_, before_.face_centre(a, I), -dt, options_.trace);
            state_.u[a](I) = sample(before_[a], a, Stencil<D>(frame_, frame_.wrap(from)));
        });
}

/// Marks the faces updated by the pressure, as far as solids leave them open, and those prescribed by walls and inflows.
template <int D>
void Water<D>::mark_liquid_faces() {
    mark_faces_of_liquid<D>(state_, frame_, known_, [&](int a, auto&& between, auto&& on_side) {
        known_[static_cast<std::size_t>(a)].fill(0);
        pressure_.for_faces_of_liquid(a, between, on_side);
    });
    in_solids_.forget(known_);
}

/// Marks the faces of walls and inflows, and those closed by solids.
template <int D>
void Water<D>::set_fixed_faces() {
    sync_periodic(state_.u, state_.sides);
    set_side_faces(state_.u, state_.sides, state_.nu);
    solids_.set_faces(state_);
    for (int a = 0; a < D; ++a) {
        auto& known = known_[static_cast<std::size_t>(a)];
        for (const int end : {0, 1}) {
            if (frame_.periodic(a) || state_.sides.open(a, end)) continue;
            Index<D> lo{};
            Extent<D> hi = known.extent();
            lo[a] = end == 0 ? 0 : frame_.cells[a];
            hi[a] = lo[a] + 1;
            for_each_in(lo, hi, [&](const Index<D>& I) { known(I) = 1; });
        }
    }
}

/// Volume control: the difference between the liquid of the markers and that of the level set moves φ by the missing volume over the
/// surface's area, at most 0.02 h per step, which is less than the motion. Markers in the air count by their own volume.
template <int D>
void Water<D>::control_volume() {
    if (!options_.volume_control) return;
    const auto timed = passes_.time("effect volume_control");
    const std::int64_t airborne = sum_of_ranks(own(), static_cast<std::int64_t>(surface_.count_airborne(markers_)));
    const real missing = volume_target_ - surface_.volume() - markers_.volume * static_cast<real>(airborne);
    volume_shift_ += std::abs(surface_.regain(missing));
}

/// In the cells beside the surface, where the pressure jumps.
template <int D>
void Water<D>::curvature() {
    if (options_.sigma == 0) return;
    const auto timed = passes_.time("effect surface_tension");
    curvature_.fill(0);
    const auto& band = surface_.band();
    parallel_for(0, static_cast<int>(surface_.layer_end(1)), [&](int i) {
        const Index<D>& I = band[static_cast<std::size_t>(i)];
        if (own().contains(I[D - 1])) curvature_(I) = curvature_near(surface_.phi, frame_, I);
    });
    refresh(curvature_, frame_.periodic(D - 1));
}

template class Water<2>;
template class Water<3>;

}  // namespace weir::water
