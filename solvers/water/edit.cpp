// Steering a liquid between two steps: editing its velocity, adding and removing markers. Invariants restored afterwards: a velocity with
// ∇·u = 0 that satisfies the conditions of walls and solids and is known throughout the band; the momentum on markers; a level set that
// contains the markers; the volume balance.
#include "mac/grid/inflow.hpp"
#include "water/solver.hpp"

namespace weir::water {

/// Not editable with bodies, whose motion is coupled to the water's, nor with heat or enclosed air, whose balance would not include the
/// edit.
template <int D>
std::vector<EditableField> Water<D>::editable() {
    if (bodies_ || heat_ || options_.encloses_air) return {};
    EditableField velocity{"", "velocity", {}};
    for (int a = 0; a < D; ++a) velocity.data.emplace_back(state_.u[a].values());
    keep_faces();
    return {std::move(velocity)};
}

template <int D>
void Water<D>::edited(const EditableField&) {
    take_velocity();
}

/// Stores the faces before an edit.
template <int D>
void Water<D>::keep_faces() {
    for (int a = 0; a < D; ++a) before_[a] = state_.u[a];
}

/// Projects the edited face velocity. Markers get the difference to before_, as after a step (FLIP without PIC), or the grid's velocity.
/// The next step starts with the previous pressure.
template <int D>
void Water<D>::take_velocity() {
    set_fixed_faces();
    const Grid<real, D> pressure = state_.p;
    state_.p.fill(0);
    pressure_.project(state_, surface_, 1, 0, nullptr);
    state_.p = pressure;
    extend_velocity(0);
    switch (options_.transfer) {
        case Transfer::grid:
            return;
        case Transfer::pic:
            return pic_to_markers(state_.u, frame_, markers_);
        case Transfer::flip:
            return flip_to_markers(state_.u, before_, 1, frame_, markers_);
        case Transfer::apic:
            return apic_to_markers(state_.u, frame_, markers_);
    }
}

/// Each marker adds its part of a cell's liquid, as poured markers do: the level set and the volume balance include it. New liquid has the
/// velocity of its markers.
template <int D>
bool Water<D>::add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity) {
    if (set != marker_set_name || bodies_ || heat_ || options_.encloses_air) return false;
    Markers<D> added(true, false);
    for (std::size_t i = 0; i < at.size(); ++i) {
        Vec<D> x, u;
        for (int a = 0; a < D; ++a) x[a] = at[i][a], u[a] = velocity[i][a];
        if (!is_free(x)) throw BadInput("marker " + std::to_string(i) + " would stand in a solid, or on the upper edge of the domain");
        added.add(x, u), markers_.add(x, u);
        volume_.add(frame_.cell_of(x), real(1) / Markers<D>::per_cell);
    }
    volume_target_ += frame_.cell_volume() / Markers<D>::per_cell * static_cast<real>(at.size());
    markers_.sort(frame_);
    added.sort(frame_);
    const Grid<poisson::Cell, D> before = state_.cells;
    for (std::size_t i = 0; i < added.count(); ++i) join_cell(frame_.cell_of(added.position(i)));
    find_liquid();
    follow_new_liquid(before, added);
    return true;
}

/// Removed markers reduce the volume balance by their share. A cell that loses its last marker becomes air.
template <int D>
bool Water<D>::remove_particles(std::string_view set, std::span<const unsigned char> gone) {
    if (set != marker_set_name || bodies_ || heat_ || options_.encloses_air) return false;
    const std::size_t all = markers_.count();
    std::vector<std::size_t> lost;
    for (std::size_t p = 0; p < all; ++p)
        if (gone[p]) lost.push_back(surface_.phi.linear(frame_.cell_of(markers_.position(p))));
    const real each = volume_target_ / frame_.cell_volume() / static_cast<real>(std::max<std::size_t>(all, 1));
    for (const std::size_t cell : lost) volume_.add(frame_.index_of(cell), -each);
    markers_.retain([&](std::size_t p) { return !gone[p]; });
    markers_.sort(frame_);
    volume_target_ *= static_cast<real>(markers_.count()) / static_cast<real>(all);
    for (const std::size_t cell : lost)
        if (markers_.in_cell(cell) == 0) surface_.phi[cell] = std::max(surface_.phi[cell], 0.5 * frame_.h_min());
    find_liquid();
    keep_faces();
    take_velocity();
    return true;
}

/// The liquid fraction of the cell is that of its markers, c. φ is that of a flat surface at height c h above the cell's floor, and
/// increases by h in the surrounding cells. Existing liquid is kept.
template <int D>
void Water<D>::join_cell(const Index<D>& I) {
    const real h = frame_.h_min(), full = static_cast<real>(markers_.in_cell(surface_.phi.linear(I))) / Markers<D>::per_cell;
    const real here = (0.5 - std::min<real>(full, 1)) * h;
    for (int corner = 0; corner < (D == 2 ? 9 : 27); ++corner) {
        Index<D> J = I;
        bool inside = true, same = true;
        for (int d = 0, rest = corner; d < D; ++d, rest /= 3) {
            const int by = rest % 3 - 1;
            same = same && by == 0;
            inside = inside && (by == 0 || frame_.step(J, d, by));
        }
        if (inside) surface_.phi(J) = std::min(surface_.phi(J), same ? here : here + h);
    }
}

template <int D>
void Water<D>::find_liquid() {
    surface_.redistance();
    pressure_.set_surface(surface_, not_solved_for(0), state_);
}

/// Faces beside new liquid cells get the velocity of the added markers near them.
template <int D>
void Water<D>::follow_new_liquid(const Grid<poisson::Cell, D>& before, const Markers<D>& added) {
    keep_faces();
    MacVelocity<D> theirs = state_.u;
    FaceMarks<D> reached = known_;
    markers_to_faces(added, frame_, sums_, theirs, reached);
    const auto is_new = [&](const Index<D>& I) { return state_.cells(I) == poisson::Cell::fluid && before(I) != poisson::Cell::fluid; };
    for (int a = 0; a < D; ++a)
        for_each_cell(state_.u[a].extent(), [&](const Index<D>& I) {
            if (reached[static_cast<std::size_t>(a)](I) && (is_new(frame_.near(I, a, -1)) || is_new(frame_.near(I, a, 0))))
                state_.u[a](I) = before_[a](I) = theirs[a](I);
        });
    take_velocity();
}

template std::vector<EditableField> Water<2>::editable();
template std::vector<EditableField> Water<3>::editable();
template void Water<2>::edited(const EditableField&);
template void Water<3>::edited(const EditableField&);
template bool Water<2>::add_particles(std::string_view, std::span<const Vec<3>>, std::span<const Vec<3>>);
template bool Water<3>::add_particles(std::string_view, std::span<const Vec<3>>, std::span<const Vec<3>>);
template bool Water<2>::remove_particles(std::string_view, std::span<const unsigned char>);
template bool Water<3>::remove_particles(std::string_view, std::span<const unsigned char>);

}  // namespace weir::water
