#include "two_phase/solver.hpp"

#include "core/error.hpp"
#include "mac/grid/closed_volume.hpp"
#include "mac/grid/inflow.hpp"
#include "mac/grid/rows.hpp"
#include "two_phase/tension.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

/// One step. Before and after it the velocity is divergence-free to the tolerance of the pressure, and the fractions of the faces are those
/// of the cells.
template <int D>
StepReport TwoPhase<D>::step(real dt) {
    whole_ = !own().distributed();
    ++ruled_[static_cast<std::size_t>(ruling_bound())];
    transport(dt);          // ∂f/∂t + ∇·(f u) = 0,  ∂(ρu)/∂t + ∇·(ρ u u) = 0
    find_face_densities();  // ρ_a of the half cells beside each face
    if (mac::move_as_prescribed(solids_.solids())) uncovered_.settle(state_, options_.rho, faces_);
    apply_viscosity(dt);                                // (ρ_a − dt ∇·2μD) u = ρ_a u
    effects_.apply(Stage::force, state_, dt, passes_);  // u += dt g
    apply_heat(dt);                                     // ∂(ρcT)/∂t = ∇·(k ∇T),  u −= dt Σ f_i ρ_i β_i (T − T_0) g / ρ_a
    apply_tension(dt);                                  // u += dt σ κ ∇f / ρ_a
    const poisson::Report poisson =
        mac::explained_by_room(state_, solids_, [&] { return project(dt, bodies_.get()); });  // u −= dt ∇p / ρ_a,  ∇·u = 0
    const real divergence = max_divergence(state_);
    mac::require_room(state_, solids_, divergence, dt, bodies_ ? std::optional(bodies_->flux_in_films()) : std::nullopt);
    find_rate();
    check();
    ++steps_;
    state_.time += dt;
    return {.dt = dt,
            .cfl = dt * rate_,
            .max_divergence = divergence,
            .iterations = poisson.iterations,
            .residual_before = poisson.residual_before,
            .residual_after = poisson.residual_after,
            .residual_max = poisson.residual_max / (state_.u.h[0] * state_.u.h[0]),
            .viscous_iterations = viscosity_ ? viscosity_->iterations() : 0};
}

template <int D>
Motion<D> TwoPhase<D>::motion(real dt) {
    for (int a = 0; a < D; ++a) fill(state_.before[a], state_.u[a], mirrored_[static_cast<std::size_t>(a)]);
    if (solids_.any()) find_open_flow<D>(state_, solids_, mirrored_, open_flow_);
    const PaddedVelocity<D>& flow = solids_.any() ? open_flow_ : state_.before;
    if (solids_.moving()) visible_.find_room(state_, flow, dt, ghosts_of_fraction_);
    const Padded<D>* room = solids_.moving() ? &visible_.room() : nullptr;
    return {state_.before, flow, dt, sweep_order<D>(steps_ + experiment_.first_order_of_sweeps), room};
}

template <int D>
void TwoPhase<D>::transport(real dt) {
    const Motion<D> motion = this->motion(dt);
    const Densities rho = experiment_.velocity_form ? Densities{} : options_.rho;
    {
        const auto timed = passes_.time("transport momentum");
        for (int a = 0; a < D; ++a) {
            const auto at = static_cast<std::size_t>(a);
            transport_.advect_momentum(a, motion, faces_[at], state_.boundary[at], rho, state_.u[a]);
        }
        move_solids(dt);
        set_side_faces(state_.u, state_.sides, state_.nu);
        solids_.set_faces(state_);
        sync_periodic(state_.u, state_.sides);
    }
    const real entered = advect_cells(motion);
    Grid<real, D>& f = state_.fields[0].values;
    const auto timed = passes_.time("transport liquid");
    if (solids_.any()) {
        ghosts_of_fraction_.fill_all(fraction_ghosts_, f);
        continued_.extend(ghosts_of_fraction_, fraction_ghosts_, f);
    }
    if (solids_.moving()) visible_.correct(state_, entered, f);
    distance_is_stale_ = true;
}

/// The liquid fractions, and the temperature in the same fluxes. Returns the liquid that came in [cells].
template <int D>
real TwoPhase<D>::advect_cells(const Motion<D>& motion) {
    Grid<real, D>& f = state_.fields[0].values;
    real entered = 0;
    {
        const auto timed = passes_.time("transport liquid");
        entered = transport_.advect_fraction(motion, fraction_ghosts_, f, heat_ ? heat_->carried() : nullptr);
        poured_ += state_.u.cell_volume() * entered;
        ghosts_of_fraction_.fill_all(fraction_ghosts_, f);
        if (!heat_) hand_on_dust(fraction_ghosts_, around_, state_.cells, f);
    }
    if (!heat_) return entered;
    const auto timed = passes_.time("advect fields");
    const CarriedByDust<D> temperatures = heat_->carried_by_dust();
    hand_on_dust(fraction_ghosts_, around_, state_.cells, f, &temperatures);
    heat_->finish_transport(state_);
    return entered;
}

/// Faces that a solid uncovers keep the velocity that was advected there.
template <int D>
void TwoPhase<D>::move_solids(real dt) {
    if (!solids_.moving()) return;
    const auto timed = passes_.time("solids");
    if (mac::move_as_prescribed(solids_.solids())) uncovered_.remember(state_);
    if (bodies_) bodies_->advance_free(solids_, dt);
    solids_.place(state_, state_.time + dt);
    see_solids();
}

/// Called after solids were placed.
template <int D>
void TwoPhase<D>::see_solids() {
    continued_ = ContinuedFractions<D>(state_, around_);
    if (solids_.moving()) visible_.see_solids(solids_, state_);
    if (viscosity_) viscosity_->see_solids(state_, solids_);
}

/// The fractions of the faces' volumes, and the response of their velocity to the pressure.
template <int D>
void TwoPhase<D>::find_face_densities() {
    const auto timed = passes_.time("densities");
    ghosts_of_fraction_.fill_all(fraction_ghosts_, fraction());
    find_face_fractions<D>(fraction_ghosts_, faces_, state_.mobility);
    const Densities rho = options_.rho;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const real scale = state_.rho;
        for_each_row(Index<D>{}, faces_[at].extent(), [&](const Index<D>& first, int count) {
            const real* f = &faces_[at](first);
            real* mobility = &state_.mobility[at](first);
#pragma omp simd
            for (int i = 0; i < count; ++i) mobility[i] = scale / rho.of(f[i]);
        });
    }
    if (experiment_.mean_density) use_mean_densities();
    exchange_densities();
}

template <int D>
void TwoPhase<D>::use_mean_densities() {
    for (int a = 0; a < D; ++a)
        for_each_cell(faces_[static_cast<std::size_t>(a)].extent(), [&](const Index<D>& I) {
            const real mean = std::clamp(0.5 * (fraction_ghosts_(I - e<D>(a)) + fraction_ghosts_(I)), 0.0, 1.0);
            state_.mobility[static_cast<std::size_t>(a)](I) = state_.rho / options_.rho.of(mean);
        });
}

template <int D>
void TwoPhase<D>::apply_viscosity(real dt) {
    if (!viscosity_) return;
    const auto timed = passes_.time("effect viscosity");
    viscosity_->apply(state_, fraction_ghosts_, faces_, options_.rho, dt);
}

template <int D>
void TwoPhase<D>::apply_heat(real dt) {
    if (!heat_) return;
    const auto timed = passes_.time("effect heat");
    ghosts_of_fraction_.fill_all(fraction_ghosts_, fraction());
    heat_->conduct(state_, fraction_ghosts_, faces_, dt);
    heat_->add_buoyancy(state_, faces_, gravity_, dt);
    heat_->check(state_);
}

template <int D>
void TwoPhase<D>::apply_tension(real dt) {
    if (options_.sigma == 0) return;
    const auto timed = passes_.time("effect surface_tension");
    refresh(state_.fields[0].values, around_.repeats(), column_reach);
    if (experiment_.fixed_curvature != 0)
        for_each_cell(curvature_.kappa.extent(), [&](const Index<D>& I) {
            curvature_.kappa(I) = is_interfacial(fraction_ghosts_, I) ? experiment_.fixed_curvature : no_curvature;
        });
    else
        find_curvature(interface(), experiment_.curvature, curvature_);
    refresh(curvature_.kappa, around_.repeats());
    add_tension<D>(state_, fraction_ghosts_, around_, curvature_.kappa, faces_, options_.rho, options_.sigma, dt);
}

template <int D>
const poisson::Report& TwoPhase<D>::project(real dt, BodiesInFlow<D>* bodies) {
    const auto timed = passes_.time("project");
    solids_.set_faces(state_);
    sync_periodic(state_.u, state_.sides);
    projection_.set_matrix(state_, &fraction());
    const poisson::Report& report = projection_.project(state_, dt, bodies, &solids_);
    if (bodies_) solids_.see_velocities(state_);
    return report;
}

/// Weymouth & Yue's measure of a step: the cells that leave a cell along all axes together. Solids cross as many cells at most.
template <int D>
void TwoPhase<D>::find_rate() {
    rate_ = max_over(rows_of<D>(state_.extent()), [&](const Index<D>& row) {
        real most = 0;
        for_each_block(row, state_.u.cells[0], [&](const Index<D>& first, int count) {
            alignas(64) real sum[row_block];
            std::fill_n(sum, count, 0.0);
            for (int a = 0; a < D; ++a) add_rate(a, first, count, sum);
            most = larger_or_nan(most, largest_magnitude(sum, static_cast<std::size_t>(count)));
        });
        return most;
    });
    if (solids_.moving()) rate_ = larger_or_nan(rate_, solids_.max_rate(state_));
    if (bodies_) rate_ = larger_or_nan(rate_, bodies_->bodies().max_rate(*std::min_element(state_.u.h.begin(), state_.u.h.end())));
}

/// The larger |u|/h of the two faces of each cell along axis a. NaN if either is.
template <int D>
void TwoPhase<D>::add_rate(int a, const Index<D>& first, int count, real* sum) const {
    const auto& u = state_.u[a];
    const auto add = [&](auto&& speed) {
        const std::ptrdiff_t up = u.stride(a);
        const real h = state_.u.h[a];
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real lower = std::abs(speed(i)), upper = std::abs(speed(i + up));
            sum[i] += (lower >= upper ? lower : upper + 0 * lower) / h;
        }
    };
    const real* q = &u(first);
    if (!solids_.any()) return add([q](std::ptrdiff_t i) { return q[i]; });
    const real* open = &state_.solid.open[static_cast<std::size_t>(a)](first);
    add([q, open](std::ptrdiff_t i) { return open[i] * q[i]; });
}

template <int D>
void TwoPhase<D>::check() const {
    if (!std::isfinite(rate_)) throw NumericalFailure("velocity", "the velocity is not finite");
    if (!std::isfinite(max_magnitude(state_.p))) throw NumericalFailure("pressure", "the pressure is not finite");
    const real outside = max_magnitude(fraction(), 0.5) - 0.5;
    if (!(outside < 0.01))
        throw NumericalFailure("fraction", "the liquid fraction of a cell is outside [0, 1] by " + std::to_string(outside));
}

/// The largest step that a bound allows; infinity where it does not apply. Half of what is stable: see stable_dt().
template <int D>
real TwoPhase<D>::limit(Bound bound) const {
    const real h = *std::min_element(state_.u.h.begin(), state_.u.h.end());
    const Densities& rho = options_.rho;
    switch (bound) {
        case Bound::speed:
            return rate_ > 0 ? options_.cfl / rate_ : infinity;
        case Bound::tension:  // Brackbill, Kothe & Zemach 1992, eq. 61
            return options_.sigma > 0 ? 0.5 * std::sqrt((rho.liquid + rho.gas) * h * h * h / (4 * pi * options_.sigma)) : infinity;
        case Bound::gravity:
            return options_.gravity > 0 ? 0.5 * std::sqrt(h / options_.gravity) : infinity;
    }
    return infinity;
}

template <int D>
Bound TwoPhase<D>::ruling_bound() const {
    Bound least = Bound::speed;
    for (const Bound bound : {Bound::tension, Bound::gravity})
        if (limit(bound) < limit(least)) least = bound;
    return least;
}

template <int D>
real TwoPhase<D>::advised_dt() const {
    return std::min(limit(ruling_bound()), effects_.max_dt(state_));
}

template <int D>
StepLimit TwoPhase<D>::stable_dt() const {
    StepLimit least{rate_ > 0 ? 0.5 / rate_ : infinity, "the fluid may leave half of a cell: the fraction stays in [0, 1] up to it"};
    if (const real dt = 2 * limit(Bound::tension); dt < least.dt) least = {dt, "the shortest capillary wave is stable up to it"};
    if (const real dt = 2 * limit(Bound::gravity); dt < least.dt) least = {dt, "the shortest gravity wave is stable up to it"};
    return least;
}

template class TwoPhase<2>;
template class TwoPhase<3>;

}  // namespace weir::two_phase
