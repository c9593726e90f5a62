// Output of the flow: fields, integrals, loads on solids, checkpoints.
#include "geometry/brush.hpp"
#include "mac/grid/diagnostics.hpp"
#include "smoke/solver.hpp"

namespace weir::smoke {

template <int D>
FieldSet FlowSolver<D>::fields() const {
    const Extent<D> shown = own().distributed_storage() ? state_.extent() : replicated<D>(state_.extent());
    FieldSet set = field_set(state_);
    if (own().distributed_storage()) set.cut = &own().partition();
    if (heat_) set.fields.push_back({"liquid", "", Where::cell, "", {heat_->liquid().values()}});
    if (wants_vorticity_) {
        vorticity(state_, shown, vorticity_);
        FieldView view{"vorticity", "1/s", Where::cell, "", {}};
        for (const auto& component : vorticity_) view.data.push_back(component.values());
        set.fields.push_back(std::move(view));
    }
    if (wants_divergence_) {
        if (divergence_.empty()) divergence_ = Grid<real, D>(state_.extent());
        for_each_cell(
            shown, [&](const Index<D>& I) { divergence_(I) = state_.cells(I) == poisson::Cell::fluid ? flux_divergence(state_, I) : 0; });
        set.fields.push_back({"divergence", "1/s", Where::cell, "", {divergence_.values()}});
    }
    if (bodies_) bodies_->bodies().show(set);
    return set;
}

template <int D>
std::vector<Integral> FlowSolver<D>::integrals() const {
    auto list = smoke::integrals(state_);
    if (heat_)
        for (auto& integral : heat_->integrals(state_)) list.push_back(std::move(integral));
    if (brush_forcing_) geometry::sum_up(*brush_forcing_, D, list);
    if (!solids_.any()) return list;
    if (bodies_)
        for (auto& integral : bodies_->bodies().integrals(bodies_->gravity())) list.push_back(std::move(integral));
    if (state_.find("smoke")) {
        list.push_back({"smoke_removed", D == 2 ? "m^2" : "m^3", smoke_removed_});
        list.push_back({"smoke_continued", D == 2 ? "m^2" : "m^3", smoke_continued_});
    }
    add_loads(list);
    return list;
}

/// Force on the solids and torque about the origin, with their pressure and friction parts.
template <int D>
void FlowSolver<D>::add_loads(std::vector<Integral>& list) const {
    const SolidLoad<D> pressure = pressure_load(state_);
    SolidLoad<D> friction;
    if (walls_ && state_.nu > 0) {
        friction = walls_->friction(state_);
    }
    const std::string force_unit = D == 2 ? "N/m" : "N", torque_unit = D == 2 ? "N" : "N m";
    const auto add = [&](const std::string& quantity, const std::string& letter, const std::string& unit, real by_pressure,
                         real by_friction) {
        list.push_back({"solid_" + quantity + letter, unit, by_pressure + by_friction});
        list.push_back({"solid_pressure_" + quantity + letter, unit, by_pressure});
        list.push_back({"solid_friction_" + quantity + letter, unit, by_friction});
    };
    for (int a = 0; a < D; ++a) {
        const std::string letter(1, "xyz"[a]);
        add("force_", letter, force_unit, pressure.force[a], friction.force[a]);
        list.push_back({"solid_impulse_" + letter, D == 2 ? "N s/m" : "N s", impulse_[a]});
    }
    for (std::size_t k = 0; k < pressure.torque.size(); ++k)
        add("torque_", D == 2 ? "z" : std::string(1, "xyz"[k]), torque_unit, pressure.torque[k], friction.torque[k]);
}

template <int D>
void FlowSolver<D>::save(Checkpoint& to) const {
    state_.save(to);
    if (bodies_) bodies_->save(to);
    to.put_value("impulse", impulse_);
    if (heat_) heat_->save(to);
    if (brush_forcing_) brush_forcing_->save(to);
    to.put_value("smoke_in_solids", std::array<real, 2>{smoke_removed_, smoke_continued_});
}

template <int D>
void FlowSolver<D>::restore(const Checkpoint& from) {
    state_.restore(from);
    if (bodies_) bodies_->restore(from, solids_);
    if (heat_) heat_->restore(from, state_);
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    whole_ = !own().distributed();
    if (walls_) walls_->forget();
    exchange_fields();
    fastest_ = not_applicable;
    impulse_ = from.template get_value<Vec<D>>("impulse");
    if (from.has("smoke_in_solids")) {
        const auto smoke = from.template get_value<std::array<real, 2>>("smoke_in_solids");
        smoke_removed_ = smoke[0], smoke_continued_ = smoke[1];
    }
    if (!solids_.moving()) return;
    solids_.place(state_, state_.time);
    projection_.set_matrix(state_);
    remember_solids();
}

template <int D>
std::size_t FlowSolver<D>::bytes() const {
    std::size_t total = state_.bytes() + characteristics_.bytes() + projection_.bytes() + solids_.bytes() + effects_.bytes();
    for (const auto& blend : velocity_blend_) total += blend.bytes();
    for (const auto& blend : field_blend_) total += blend.bytes();
    for (const auto& component : carried_.face) total += component.bytes();
    total += cuts_.bytes() + (walls_ ? walls_->bytes() : 0) + was_solid_.bytes() + (bodies_ ? bodies_->bytes() : 0);
    if (heat_) total += heat_->bytes();
    return total;
}

#define WEIR_INSTANTIATE(D)                                          \
    template FieldSet FlowSolver<D>::fields() const;                 \
    template std::vector<Integral> FlowSolver<D>::integrals() const; \
    template void FlowSolver<D>::save(Checkpoint& to) const;         \
    template void FlowSolver<D>::restore(const Checkpoint& from);    \
    template std::size_t FlowSolver<D>::bytes() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::smoke
