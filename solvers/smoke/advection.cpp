// Dq/Dt = 0 and Du/Dt = 0: along characteristics (Stam 1999; MacCormack: Selle et al. 2008) or in flux form with a Runge-Kutta scheme, with
// the fields before the step and their ghosts.
#include "smoke/solver.hpp"

#include <algorithm>

namespace weir::smoke {

int planes_reached(real cells, int planes) {
    if (!(cells < planes)) return planes;
    return std::min(planes, static_cast<int>(std::ceil(cells)) + ghost_layers);
}

template <int D>
void FlowSolver<D>::remember(real dt) {
    const auto timed = passes_.time("ghosts");
    real fluid = 0;  // max |u|/h
    for (int a = 0; a < D; ++a)
        fluid = larger_or_nan(
            fluid, fill_planes_and_measure(state_.before[a], state_.u[a], state_.boundary[static_cast<std::size_t>(a)]) / state_.u.h[a]);
    const real fastest = rate(fluid);
    trace_.set_max_rate(fastest);
    state_.reach = planes_reached(dt * fastest, state_.extent()[D - 1]);
    characteristics_.set_reach(state_.reach);
    fill_field_planes();
    fill_end_planes(remembered_, planes_to_extend());
    solids_.fill_ghosts(state_, state_.reach + 3);
    solids_.extend_velocity(state_);
    extend_fields();
}

/// In parallel: ghost planes needed so that the extrapolation into solids is complete to the depth that the step reads. It depends on
/// neighbours' values and on other extrapolated ones.
template <int D>
int FlowSolver<D>::planes_to_extend() const {
    return solids_.any() ? state_.reach + 2 : state_.reach;
}

template <int D>
void FlowSolver<D>::fill_field_planes() {
    for (auto& field : state_.fields)
        if (!field.derived) fill_planes(field.before, field.values, field.boundary);
}

template <int D>
void FlowSolver<D>::extend_fields() {
    if (!solids_.any()) return;
    const bool ring = state_.sides.periodic(D - 1);
    for (auto& field : state_.fields)
        if (!field.derived) solids_.extend_field(state_, field.before, ring ? 0 : state_.reach);
    if (ring) refresh(remembered_fields_, state_.reach);
}

/// Forces on a face depend on the cells on both sides.
template <int D>
void FlowSolver<D>::refresh_fields() {
    if (!own().distributed() || state_.fields.empty()) return;
    shared_.clear();
    for (auto& field : state_.fields) shared_.push_back(planes_of(field.values));
    communicator().refresh(own().partition(), shared_, 1, state_.sides.periodic(D - 1));
}

template <int D>
void FlowSolver<D>::advect_fields(real dt) {
    if (state_.fields.empty()) return;
    const auto timed = passes_.time("advect fields");
    if (options_.scheme != Scheme::conservative) return characteristics_.advect(carried_fields_, all_cells<D>(state_.extent()), trace_, dt);
    for (auto& field : state_.fields) {
        if (field.derived) continue;
        if (solids_.moving())  // a cell that a body uncovers starts with extrapolated values
            for_each_cell(state_.extent(), [&](const Index<D>& I) {
                if (state_.cells(I) == poisson::Cell::solid) field.values(I) = field.before(I);
            });
        add_field_flux(field.before, state_.before, state_.solid, state_.u.h, options_.flux, dt, field.values);
        if (solids_.moving()) keep_uniform_at_solids(field.before, state_.before, state_.solid, state_.u.h, dt, field.values);
    }
}

/// MacCormack advects the velocity minus half of the old pressure gradient and adds that half on arrival: the trapezoidal rule along the
/// trajectory. Without it a step is first order in dt (equivalent to the reflection of Narain, Zehnder & Thomaszewski 2019).
template <int D>
void FlowSolver<D>::advect_velocity(real dt) {
    const auto timed = passes_.time("advect velocity");
    const bool second_order = options_.scheme == Scheme::maccormack;
    if (options_.scheme == Scheme::conservative && solids_.any() && (solids_.moving() || !cuts_.found())) cuts_.find(state_);
    const PressurePush<D> taken(state_, -0.5 * dt / state_.rho), given_back(state_, 0.5 * dt / state_.rho);
    if (second_order) {
        for (int a = 0; a < D; ++a)
            for_each_plane(carried_[a].extent(), [&](int plane) {
                fill_plane(carried_[a], state_.boundary[static_cast<std::size_t>(a)], plane,
                           [&](const Index<D>& first, int count, real* row) {
                               std::copy_n(&state_.u[a](first), count, row);
                               taken.add(a, first, count, row);
                           });
            });
        fill_end_planes(carried_velocity_, state_.reach);
    }
    for (int a = 0; a < D; ++a) {
        const auto& boundary = state_.boundary[static_cast<std::size_t>(a)];
        const auto faces = free_faces(state_.u, state_.sides, a);
        if (options_.scheme == Scheme::conservative) {
            if (solids_.any())
                cuts_.add_momentum_flux(state_, a, dt, state_.u[a]);
            else
                add_momentum_flux(state_.before, state_.u.h, faces, dt, state_.u[a]);
            continue;
        }
        if (!second_order) {
            characteristics_.advect(state_.before[a], boundary, faces, trace_, dt, state_.u[a]);
            continue;
        }
        characteristics_.advect(carried_[a], boundary, faces, trace_, dt, state_.u[a], &given_back);
    }
    sync_periodic(state_.u, state_.sides);
}

template <int D>
void FlowSolver<D>::blend(const Substep& stage) {
    if (options_.scheme != Scheme::conservative) return;
    const auto timed = passes_.time("blend");
    for (int a = 0; a < D; ++a) velocity_blend_[static_cast<std::size_t>(a)].blend(stage, state_.before[a], state_.u[a]);
    for (std::size_t i = 0; i < state_.fields.size(); ++i)
        if (!state_.fields[i].derived) field_blend_[i].blend(stage, state_.fields[i].before, state_.fields[i].values);
}

#define WEIR_INSTANTIATE(D)                                \
    template void FlowSolver<D>::remember(real dt);        \
    template int FlowSolver<D>::planes_to_extend() const;  \
    template void FlowSolver<D>::fill_field_planes();      \
    template void FlowSolver<D>::extend_fields();          \
    template void FlowSolver<D>::refresh_fields();         \
    template void FlowSolver<D>::advect_fields(real dt);   \
    template void FlowSolver<D>::advect_velocity(real dt); \
    template void FlowSolver<D>::blend(const Substep& stage);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::smoke
