// Output of the liquid: fields, integrals, checkpoints.
#include "free_surface/measure.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/diagnostics.hpp"
#include "parallel/plane_checkpoint.hpp"
#include "water/solver.hpp"

namespace weir::water {

using poisson::Cell;

template <int D>
FieldSet Water<D>::fields() const {
    FieldSet set;
    set.grid = grid_view(state_.u);
    if (own().distributed_storage()) set.cut = &own().partition();
    set.particles_in_parts = own().distributed_storage();
    const Markers<D>& markers = set.particles_in_parts ? markers_ : all_markers();
    const auto [first, last] = set.particles_in_parts ? markers_.own(frame_) : std::pair{std::size_t{0}, markers.count()};
    FieldView velocity{"velocity", "m/s", Where::face, "", {}}, position{"position", "m", Where::particle, marker_set_name, {}};
    FieldView carried{"velocity", "m/s", Where::particle, marker_set_name, {}};
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        velocity.data.push_back(state_.u[a].values());
        position.data.push_back(std::span(markers.x[at]).subspan(first, last - first));
        if (markers.carries_velocity()) carried.data.push_back(std::span(markers.v[at]).subspan(first, last - first));
    }
    set.fields.push_back(std::move(velocity));
    set.fields.push_back({"pressure", "Pa", Where::cell, "", {state_.p.values()}});
    if (heat_) set.fields.push_back(heat_->temperature()), set.fields.push_back(heat_->liquid());
    set.fields.push_back({level_set_name, "m", Where::cell, "", {surface_.phi.values()}});
    set.fields.push_back(std::move(position));
    if (markers_.carries_velocity()) set.fields.push_back(std::move(carried));
    if (bodies_) bodies_->bodies().show(set);
    return set;
}

template <int D>
std::vector<Integral> Water<D>::integrals() const {
    const auto [first, last] = markers_.own(frame_);
    const auto count = static_cast<real>(sum_of_ranks(own(), static_cast<std::int64_t>(last - first)));
    const std::int64_t escaped = sum_of_ranks(own(), escaped_), reseeded = sum_of_ranks(own(), reseeded_);
    const Measure<D> measure(frame_, surface_, closed_, keeps_volume_ ? &volume_.part() : nullptr);
    std::vector<Integral> list = measure.integrals(leapfrog_.at_end(state_.u, frame_), state_.rho, gravity_, up_, volume_target_);
    list.insert(list.begin() + 1, {"surface_volume", list[0].unit, list[0].value});
    if (keeps_volume_) list[0].value = volume_.volume();
    list.insert(list.begin() + 2, {"marker_volume", list[0].unit, markers_.volume * count});
    list.push_back({"markers", "", count});
    for (auto& integral : pressure_.pocket_integrals(state_)) list.push_back(std::move(integral));
    if (options_.volume_control) list.push_back({"volume_shift", "m", volume_shift_});
    if (brush_forcing_) geometry::sum_up(*brush_forcing_, D, list);
    if (heat_)
        for (auto& integral : heat_->integrals(state_, volume_target_)) list.push_back(std::move(integral));
    list.push_back({"escaped_markers", "", static_cast<real>(escaped)});
    list.push_back({"reseeded_markers", "", static_cast<real>(reseeded)});
    if (bodies_)
        for (auto& integral : bodies_->bodies().integrals(gravity_)) list.push_back(std::move(integral));
    return list;
}

template <int D>
void Water<D>::save(Checkpoint& to) const {
    const std::array<std::int64_t, 3> counts{steps_, sum_of_ranks(own(), escaped_), sum_of_ranks(own(), reseeded_)};
    state_.save(to);
    if (bodies_) bodies_->save(to);
    surface_.save(to);
    leapfrog_.save(to);
    volume_.save(to);
    pressure_.save(to);
    const auto [first, last] = markers_.own(frame_);
    const std::vector<std::size_t> begins = begins_of_ranks(last - first);
    int at = 0;
    markers_.for_each_array([&, begin = first, count = last - first](const std::vector<real>& array) {
        to.put_part("water.markers." + std::to_string(at++), std::span(array).subspan(begin, count),
                    begins[static_cast<std::size_t>(communicator().rank())], begins.back());
    });
    const std::array<real, 3> reals{volume_target_, markers_.volume, volume_shift_};
    to.put_value("water.reals", reals);
    to.put_value("water.counts", counts);
    to.put_value("water.rate", rate_);
    if (brush_forcing_) brush_forcing_->save(to);
    if (heat_) heat_->save(to);
}

/// In parallel each rank reads an equal part and sends the markers to the ranks that store them.
template <int D>
void Water<D>::restore_markers(const Checkpoint& from) {
    int at = 0;
    std::size_t all = 0;
    markers_.for_each_array([&](std::vector<real>& array) {
        const std::string name = "water.markers." + std::to_string(at++);
        Checkpoint::Held held = from.held<real>(name);
        if (!held.part) held = held.share(communicator().rank(), communicator().ranks());
        array.resize(held.end - held.begin);
        from.get_part(name, std::span<real>(array), held.begin, held.all);
        Checkpoint::require_finite(name, array);
        if (at == 1) all = held.all;
        if (held.all != all) throw std::runtime_error("checkpoint block \"" + name + "\" is of another number of markers than the first");
    });
    if (own().distributed())
        markers_.deal(frame_);
    else
        markers_.sort(frame_);
}

template <int D>
void Water<D>::restore(const Checkpoint& from) {
    state_.time = from.get_value<real>("time");
    if (bodies_ || solids_.moving() || state_.time == 0) state_.restore(from);  // where solids are placed again
    if (bodies_) bodies_->restore(from, solids_);
    place_solids(state_.time);
    state_.restore(from);  // liquid flags after the solids' flags
    surface_.restore(from);
    leapfrog_.restore(from);
    if (volume_.is_saved(from))
        volume_.restore(from);
    else
        volume_.start(surface_, state_);  // files of older versions have no such block
    restore_markers(from);
    const auto reals = from.get_value<std::array<real, 3>>("water.reals");
    const auto counts = get_counts<3>(from, "water.counts");
    Checkpoint::require_finite("water.reals", reals);
    volume_target_ = reals[0], markers_.volume = reals[1], volume_shift_ = reals[2];
    steps_ = counts[0], escaped_ = communicator().rank() == 0 ? counts[1] : 0, reseeded_ = communicator().rank() == 0 ? counts[2] : 0;
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    whole_ = !own().distributed();
    synchronize();
    pressure_.restore(from);
    pressure_.set_surface(surface_, closed_, state_);
    if (heat_) heat_->restore(from, state_);
    mark_liquid_faces();
    rate_ = from.has("water.rate") ? from.get_value<real>("water.rate") : max_speed_rate();
}

template <int D>
std::size_t Water<D>::bytes() const {
    std::size_t total = state_.bytes() + markers_.bytes() + surface_.bytes() + volume_.bytes() + pressure_.bytes() + extrapolate_.bytes() +
                        before_.bytes() + leapfrog_.bytes() +
                        (viscosity_ ? viscosity_->bytes() + friction_->bytes() + sizeof(*viscosity_) + sizeof(*friction_) : 0) +
                        (heat_ ? heat_->bytes() : 0) + closed_.bytes() + near_solid_.bytes() + not_solved_for_.bytes() +
                        curvature_.bytes() + in_solids_.bytes();
    if (own().distributed()) total += all_markers_.bytes();
    if (bodies_) total += bodies_->bytes();
    for (const auto& emitter : emitters_) total += emitter.bytes();
    for (const auto& sum : sums_.sum) total += sum.bytes();
    for (const auto& known : known_) total += known.bytes();
    return total;
}

#define WEIR_INSTANTIATE(D)                                     \
    template FieldSet Water<D>::fields() const;                 \
    template std::vector<Integral> Water<D>::integrals() const; \
    template void Water<D>::save(Checkpoint&) const;            \
    template void Water<D>::restore(const Checkpoint&);         \
    template std::size_t Water<D>::bytes() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
