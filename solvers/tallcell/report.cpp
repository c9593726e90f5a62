// Output and steering of liquid on tall cells: fields, integrals, checkpoints, an edited velocity.
#include "free_surface/measure.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/diagnostics.hpp"
#include "parallel/plane_checkpoint.hpp"
#include "tallcell/solver.hpp"

namespace weir::tallcell {

template <int D>
FieldSet TallCells<D>::fields() const {
    if (!own().distributed()) pressure_.write_heights(tall_);
    FieldSet set;
    set.grid = grid_view(state_.u);
    if (own().distributed_storage()) set.cut = &own().partition();
    FieldView velocity{"velocity", "m/s", Where::face, "", {}};
    for (int a = 0; a < D; ++a) velocity.data.push_back(state_.u[a].values());
    set.fields.push_back(std::move(velocity));
    set.fields.push_back({"pressure", "Pa", Where::cell, "", {state_.p.values()}});
    set.fields.push_back({level_set_name, "m", Where::cell, "", {surface_.phi.values()}});
    set.fields.push_back({"cell_height", "m", Where::cell, "", {tall_.values()}});
    return set;
}

template <int D>
std::vector<Integral> TallCells<D>::integrals() const {
    std::vector<Integral> list = Measure<D>(frame_, surface_, closed_, &volume_.part())
                                     .integrals(leapfrog_.at_end(state_.u, frame_), state_.rho, gravity_, up_, volume_target_);
    list.insert(list.begin() + 1, {"surface_volume", list[0].unit, list[0].value});
    list[0].value = volume_.volume();
    list.push_back({"pressure_unknowns", "", static_cast<real>(pressure_.unknowns())});
    if (brush_forcing_) geometry::sum_up(*brush_forcing_, D, list);
    if (options_.volume_control) list.push_back({"volume_shift", "m", volume_shift_});
    return list;
}

template <int D>
void TallCells<D>::save(Checkpoint& to) const {
    state_.save(to);
    surface_.save(to);
    leapfrog_.save(to);
    volume_.save(to);
    const std::array<real, 3> reals{volume_target_, volume_shift_, rate_};
    to.put_value("tallcell.reals", reals);
    to.put_value("tallcell.steps", steps_);
    if (brush_forcing_) brush_forcing_->save(to);
}

template <int D>
void TallCells<D>::restore(const Checkpoint& from) {
    state_.time = from.get_value<real>("time");
    steps_ = get_count(from, "tallcell.steps");
    place_solids(state_.time);
    state_.restore(from);  // liquid flags after the solids' flags
    surface_.restore(from);
    leapfrog_.restore(from);
    if (volume_.is_saved(from))
        volume_.restore(from);
    else
        volume_.start(surface_, state_);  // files of older versions have no such block
    const auto reals = from.get_value<std::array<real, 3>>("tallcell.reals");
    Checkpoint::require_finite("tallcell.reals", reals);
    volume_target_ = reals[0], volume_shift_ = reals[1], rate_ = reals[2];
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    remesh();
    mark_liquid_faces();
    whole_ = !own().distributed();
}

template <int D>
std::vector<EditableField> TallCells<D>::editable() {
    EditableField velocity{"", "velocity", {}};
    for (int a = 0; a < D; ++a) velocity.data.emplace_back(state_.u[a].values());
    return {std::move(velocity)};
}

/// Projects an edited velocity: representable by tall cells (linear within each), with ∇·u = 0 and the conditions of walls, known
/// throughout the band. The next step starts with the previous pressure.
template <int D>
void TallCells<D>::edited(const EditableField&) {
    set_fixed_faces();
    const Grid<real, D> pressure = state_.p;
    state_.p.fill(0);
    pressure_.restrict_velocity(state_);
    pressure_.project(surface_.phi, state_, 1, solids_.moving());
    pressure_.spread(state_, 1);
    sync_periodic(state_.u, state_.sides);
    state_.p = pressure;
    extend_velocity();
}

template <int D>
std::size_t TallCells<D>::bytes() const {
    std::size_t total = state_.bytes() + surface_.bytes() + volume_.bytes() + pressure_.bytes() + transport_.bytes() +
                        extrapolate_.bytes() + leapfrog_.bytes() + closed_.bytes() + in_solids_.bytes() + solids_.bytes() + tall_.bytes();
    for (const auto& known : known_) total += known.bytes();
    return total;
}

#define WEIR_INSTANTIATE(D)                                         \
    template FieldSet TallCells<D>::fields() const;                 \
    template std::vector<Integral> TallCells<D>::integrals() const; \
    template void TallCells<D>::save(Checkpoint&) const;            \
    template void TallCells<D>::restore(const Checkpoint&);         \
    template std::vector<EditableField> TallCells<D>::editable();   \
    template void TallCells<D>::edited(const EditableField&);       \
    template std::size_t TallCells<D>::bytes() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::tallcell
