// Output of both phases: fields, integrals, checkpoints.
#include "free_surface/level_set.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/diagnostics.hpp"
#include "parallel/plane_checkpoint.hpp"
#include "two_phase/level_set.hpp"
#include "two_phase/solver.hpp"

#include <cmath>

namespace weir::two_phase {

template <int D>
void TwoPhase<D>::update_distance() const {
    if (distance_.empty()) distance_ = Grid<real, D>(state_.extent());
    if (distance_is_stale_) find_distance(interface(), distance_);
    distance_is_stale_ = false;
}

template <int D>
FieldSet TwoPhase<D>::fields() const {
    FieldSet set = field_set(state_);
    if (own().distributed_storage()) set.cut = &own().partition();
    update_distance();
    set.fields.push_back({level_set_name, "m", Where::cell, "", {distance_.values()}});
    if (bodies_) bodies_->bodies().show(set);
    return set;
}

/// Σ ρ_a power(u) over the volumes of the faces along an axis: half a volume on sides, none for the second copy of a periodic face.
template <int D>
real TwoPhase<D>::sum_of_faces(int a, real (*power)(real)) const {
    const int n = state_.u.cells[a];
    const auto& fractions = faces_[static_cast<std::size_t>(a)];
    return state_.u.cell_volume() * sum_over(state_.u[a].extent(), [&](const Index<D>& I) {
               const bool inside = I[a] > 0 && I[a] < n;
               const real share = inside ? 1 : state_.sides.periodic(a) ? (I[a] == 0 ? 1 : 0) : 0.5;
               const real open = solids_.any() ? state_.solid.open[static_cast<std::size_t>(a)](I) : 1;
               return share * open * options_.rho.of(fractions(I)) * power(state_.u[a](I));
           });
}

/// ∫ f (x − origin) dV: the liquid of a mixed cell lies below its plane.
template <int D>
Vec<D> TwoPhase<D>::moment_of_liquid() const {
    const Strides<D> stride = strides_of(fraction_ghosts_);
    Vec<D> moment;
    for (int d = 0; d < D; ++d)
        moment[d] = state_.u.cell_volume() * sum_over(state_.extent(), [&](const Index<D>& I) {
                        const real part = room(I);
                        if (part == 0) return 0.0;
                        const real f = fraction()(I), sum = f * (state_.u.cell_centre(I)[d] - state_.u.origin[d]);
                        if (!is_mixed(f)) return part * sum;
                        const Plane<D> plane = plane_at<D>(fraction_ghosts_.at(I), stride);
                        real value = -plane.alpha;
                        for (int k = 0; k < D; ++k) value += 0.5 * plane.m[k];
                        return part * (sum + state_.u.h[d] * free_surface::moment_below_plane(value, plane.m)[d]);
                    });
    return moment;
}

/// ∫ (x − origin) dV over the cells that hold fluid.
template <int D>
Vec<D> TwoPhase<D>::moment_of_space() const {
    const real cell = state_.u.cell_volume(), box = cell * static_cast<real>(product(state_.u.cells));
    Vec<D> moment;
    for (int d = 0; d < D; ++d) {
        const real h = state_.u.h[d];
        moment[d] = 0.5 * box * h * state_.u.cells[d];
        if (solids_.any()) moment[d] = cell * h * sum_over(state_.extent(), [&](const Index<D>& I) { return room(I) * (I[d] + 0.5); });
    }
    return moment;
}

/// Volumes, centres of volume, and potential energy: −g·∫ρ (x − origin) dV.
template <int D>
void TwoPhase<D>::add_volumes(std::vector<Integral>& list) const {
    const std::string unit = D == 2 ? "m^2" : "m^3";
    const real cell = state_.u.cell_volume();
    const real liquid = cell * sum_over(state_.extent(), [&](const Index<D>& I) { return room(I) * fraction()(I); });
    const real gas = cell * sum_over(state_.extent(), [&](const Index<D>& I) { return room(I) * (1 - fraction()(I)); });
    const real least = 1e-6 * cell;  // less is what the divergence that the pressure left makes of a fluid that is not there
    const Vec<D> of_liquid = moment_of_liquid(), of_gas = moment_of_space() - of_liquid;
    list.push_back({"volume", unit, liquid});
    list.push_back({"gas_volume", unit, gas});
    if (has_open_sides()) list.push_back({"poured_volume", unit, poured_});
    if (solids_.moving()) {
        list.push_back({"volume_corrected", unit, cell * visible_.corrected()});
        list.push_back({"volume_corrections", unit, cell * visible_.corrections()});
    }
    list.push_back({"potential_energy", D == 2 ? "J/m" : "J", -dot(gravity_, options_.rho.liquid * of_liquid + options_.rho.gas * of_gas)});
    for (int d = 0; d < D; ++d) {
        const std::string axis(1, "xyz"[d]);
        const real speed = cell * sum_over(state_.extent(), [&](const Index<D>& I) {
                               return room(I) * (1 - fraction()(I)) * 0.5 * (state_.u[d](I) + state_.u[d](I + e<D>(d)));
                           });
        list.push_back({"centre_" + axis, "m", liquid > least ? state_.u.origin[d] + of_liquid[d] / liquid : not_applicable});
        list.push_back({"gas_centre_" + axis, "m", gas > least ? state_.u.origin[d] + of_gas[d] / gas : not_applicable});
        list.push_back({"gas_velocity_" + axis, "m/s", gas > least ? speed / gas : not_applicable});
    }
}

/// The largest coordinate along an axis at which f falls below ½, on straight lines between the middles of cells.
template <int D>
real TwoPhase<D>::furthest(int axis) const {
    const Grid<real, D>& f = fraction();
    const int n = state_.u.cells[axis];
    const real h = state_.u.h[axis], end = state_.u.origin[axis] + h * n;
    return max_over(state_.extent(), [&](const Index<D>& I) {
        const real here = f(I), x = state_.u.cell_centre(I)[axis];
        if (here < 0.5 || !is_open(state_, I)) return -infinity;
        if (I[axis] + 1 == n || !is_open(state_, I + e<D>(axis))) return std::min(end, x + h * (here - 0.5));
        const real there = f(I + e<D>(axis));
        return there >= 0.5 ? -infinity : x + h * (here - 0.5) / (here - there);
    });
}

template <int D>
std::vector<Integral> TwoPhase<D>::integrals() const {
    const std::string per_depth = D == 2 ? "/m" : "";
    real kinetic = 0, fastest = 0;
    Vec<D> momentum;
    for (int a = 0; a < D; ++a) {
        kinetic += 0.5 * sum_of_faces(a, [](real u) { return u * u; });
        momentum[a] = sum_of_faces(a, [](real u) { return u; });
        fastest = std::max(fastest, max_magnitude(state_.u[a]));
    }
    std::vector<Integral> list;
    add_volumes(list);
    list.push_back({"kinetic_energy", "J" + per_depth, kinetic});
    list.push_back({"max_speed", "m/s", fastest});
    list.push_back({"front_x", "m", furthest(0)});
    list.push_back({"top", "m", furthest(up_)});
    for (int a = 0; a < D; ++a) list.push_back({std::string("momentum_") + "xyz"[a], "kg m/s" + per_depth, momentum[a]});
    const char* const rules[bounds] = {"steps_bound_by_speed", "steps_bound_by_tension", "steps_bound_by_gravity"};
    for (std::size_t i = 0; i < bounds; ++i) list.push_back({rules[i], "", static_cast<real>(ruled_[i])});
    if (heat_) heat_->add_integrals(state_, has_open_sides(), list);
    if (brush_forcing_) geometry::sum_up(*brush_forcing_, D, list);
    if (bodies_)
        for (auto& integral : bodies_->bodies().integrals(gravity_)) list.push_back(std::move(integral));
    return list;
}

template <int D>
void TwoPhase<D>::save(Checkpoint& to) const {
    state_.save(to);
    to.put_value("two_phase.steps", steps_);
    to.put_value("two_phase.ruled", ruled_);
    if (has_open_sides()) to.put_value("two_phase.poured", poured_);
    if (heat_) heat_->save(to);
    if (brush_forcing_) brush_forcing_->save(to);
    if (bodies_) bodies_->save(to);
    if (solids_.moving()) visible_.save(to);
}

template <int D>
void TwoPhase<D>::restore(const Checkpoint& from) {
    state_.restore(from);
    steps_ = get_count(from, "two_phase.steps");
    ruled_ = get_counts<bounds>(from, "two_phase.ruled");
    if (has_open_sides()) poured_ = from.get_value<real>("two_phase.poured");
    if (heat_) heat_->restore(from);
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    whole_ = !own().distributed();
    refresh(state_.u[D - 1], around_.repeats());
    if (bodies_) bodies_->restore(from, solids_);
    if (solids_.moving()) {
        solids_.place(state_, state_.time);
        see_solids();
        visible_.restore(from);
    }
    find_face_densities();
    find_rate();
    distance_is_stale_ = true;
}

template <int D>
std::size_t TwoPhase<D>::bytes() const {
    std::size_t total = state_.bytes() + transport_.bytes() + fraction_ghosts_.bytes() + curvature_.bytes() + projection_.bytes() +
                        effects_.bytes() + distance_.bytes() + solids_.bytes() + continued_.bytes() + visible_.bytes() +
                        uncovered_.bytes() + (bodies_ ? bodies_->bytes() : 0) +
                        (viscosity_ ? viscosity_->bytes() + sizeof(*viscosity_) : 0) + (heat_ ? heat_->bytes() + sizeof(*heat_) : 0);
    for (const auto& fractions : faces_) total += fractions.bytes();
    for (const auto& component : open_flow_.face) total += component.bytes();
    return total;
}

#define WEIR_INSTANTIATE(D)                                               \
    template void TwoPhase<D>::update_distance() const;                   \
    template FieldSet TwoPhase<D>::fields() const;                        \
    template real TwoPhase<D>::sum_of_faces(int, real (*)(real)) const;   \
    template Vec<D> TwoPhase<D>::moment_of_liquid() const;                \
    template Vec<D> TwoPhase<D>::moment_of_space() const;                 \
    template void TwoPhase<D>::add_volumes(std::vector<Integral>&) const; \
    template real TwoPhase<D>::furthest(int) const;                       \
    template std::vector<Integral> TwoPhase<D>::integrals() const;        \
    template void TwoPhase<D>::save(Checkpoint&) const;                   \
    template void TwoPhase<D>::restore(const Checkpoint&);                \
    template std::size_t TwoPhase<D>::bytes() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
