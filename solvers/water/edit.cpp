// Water that is changed between two steps: its velocity, and markers that come and go. What is made good afterwards: a velocity that walls,
// solids and ∇·u = 0 allow, known throughout the band; markers that carry it; a level set that has the markers in it; the ledger.
#include "staggered/inflow.hpp"
#include "water/solver.hpp"

namespace weir::water {

/// Not beside bodies, whose motion goes with the water's, nor with heat, whose ledger would not know.
template <int D>
std::vector<EditableField> Water<D>::editable() {
    if (bodies_ || heat_) return {};
    EditableField velocity{"", "velocity", {}};
    for (int a = 0; a < D; ++a) velocity.data.emplace_back(state_.u[a].values());
    keep_faces();
    return {std::move(velocity)};
}

template <int D>
void Water<D>::edited(const EditableField&) {
    take_velocity();
}

/// As they are before an edit.
template <int D>
void Water<D>::keep_faces() {
    for (int a = 0; a < D; ++a) before_[a] = state_.u[a];
}

/// The velocity as it stands on the faces, made possible; markers are given the difference to before_, as after a step (FLIP without any
/// PIC), or what the grid has. The pressure that the next step begins with is that of before.
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

/// Each is a part of a cell's liquid, as those that are poured are: the level set joins it, the ledger counts it. New liquid moves as its
/// markers do.
template <int D>
bool Water<D>::add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity) {
    if (set != marker_set_name || bodies_ || heat_) return false;
    Markers<D> added(true, false);
    for (std::size_t i = 0; i < at.size(); ++i) {
        Vec<D> x, u;
        for (int a = 0; a < D; ++a) x[a] = at[i][a], u[a] = velocity[i][a];
        if (!is_free(x)) throw BadInput("marker " + std::to_string(i) + " would stand in a solid, or on the upper edge of the domain");
        added.add(x, u), markers_.add(x, u);
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

/// They take their share of the ledger's volume with them. A cell that loses the last of its markers is air.
template <int D>
bool Water<D>::remove_particles(std::string_view set, std::span<const unsigned char> gone) {
    if (set != marker_set_name || bodies_ || heat_) return false;
    const std::size_t all = markers_.count();
    std::vector<std::size_t> lost;
    for (std::size_t p = 0; p < all; ++p)
        if (gone[p]) lost.push_back(surface_.phi.linear(frame_.cell_of(markers_.position(p))));
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

/// A cell is as full of liquid as of markers: c of it under a flat surface, which lies c h above its floor and as far below the middles of
/// the cells around. What there is already stays.
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

/// Faces beside cells that were no liquid move as the added markers near them.
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
