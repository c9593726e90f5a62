// Solids and bodies in the flow: their motion, no-slip walls, friction on them, and smoke removed from inside them.
#include "smoke/solver.hpp"

namespace weir::smoke {

/// Bodies move before friction, which uses their new position.
template <int D>
void FlowSolver<D>::move_no_slip_bodies(real t, real dt) {
    bodies_->leave(state_, dt);
    place_solids(t, dt);
    const auto timed = passes_.time("solids");
    bodies_->set_no_slip_walls(state_, solids_, dt);
}

/// Viscosity acts before solids move, with walls at their new position.
template <int D>
void FlowSolver<D>::meet_walls(real now, real last) {
    const auto timed = passes_.time("solids");
    solids_.solids().set_time(now);
    walls_->find(state_, solids_, now, last);
    const bool found = state_.no_slip_walls && !state_.no_slip_walls->takes_part[0].empty();  // once bodies have been found
    for (int a = 0; found && a < D; ++a)
        for (const HeldFace<D>& f : walls_->held(a)) state_.no_slip_walls->takes_part[static_cast<std::size_t>(a)](f.face) = 0;
}

/// Friction force on no-slip solids. In parallel, the stress at a subdomain boundary needs the values of both sides.
template <int D>
Vec<D> FlowSolver<D>::friction() {
    if (!walls_ || !walls_->no_slip() || state_.nu == 0) return {};
    for (int a = 0; a + 1 < D; ++a) refresh(state_.u[a], state_.sides.periodic(D - 1));
    return walls_->friction(state_).force;
}

template <int D>
void FlowSolver<D>::move_solids(real t, real dt) {
    if (!state_.no_slip_walls) place_solids(t, dt);
    if (walls_ && solids_.moving()) meet_walls(t, t);  // the faces that are open now
    solids_.set_faces(state_);
}

template <int D>
void FlowSolver<D>::place_solids(real t, real dt) {
    if (!solids_.any()) return;
    const auto timed = passes_.time("solids");
    if (bodies_) bodies_->advance_free(solids_, dt);
    if (!solids_.moving()) return;
    solids_.place(state_, t);
    projection_.set_matrix(state_);
}

/// Removes smoke from solids. Recorded: smoke in cells that a body has covered since the last step, and gains in cells that it has
/// uncovered. Other solid cells contain only extrapolated values.
template <int D>
void FlowSolver<D>::clear_solids() {
    auto* smoke = state_.find("smoke");
    if (!solids_.any() || !smoke) return;
    const auto sum = [&](auto&& counts) {
        return state_.u.cell_volume() * sum_over(state_.extent(), [&](const Index<D>& I) { return counts(I) ? (*smoke)(I) : 0; });
    };
    const auto solid = [&](const Index<D>& I) { return state_.cells(I) == poisson::Cell::solid; };
    if (!was_solid_.empty()) {
        smoke_removed_ += sum([&](const Index<D>& I) { return solid(I) && !was_solid_(I); });
        smoke_continued_ += sum([&](const Index<D>& I) { return !solid(I) && was_solid_(I); });
    }
    remember_solids();
    for_each_cell(state_.extent(), [&](const Index<D>& I) {
        if (state_.cells(I) == poisson::Cell::solid) (*smoke)(I) = 0;
    });
}

template <int D>
void FlowSolver<D>::remember_solids() {
    if (was_solid_.empty()) return;
    for_each_cell(state_.extent(), [&](const Index<D>& I) { was_solid_(I) = state_.cells(I) == poisson::Cell::solid; });
}

#define WEIR_INSTANTIATE(D)                                            \
    template void FlowSolver<D>::move_no_slip_bodies(real t, real dt); \
    template void FlowSolver<D>::meet_walls(real now, real last);      \
    template Vec<D> FlowSolver<D>::friction();                         \
    template void FlowSolver<D>::move_solids(real t, real dt);         \
    template void FlowSolver<D>::clear_solids();                       \
    template void FlowSolver<D>::remember_solids();
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::smoke
