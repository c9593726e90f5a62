// Flow fields written between two steps, and the restored invariants: a velocity that satisfies ∇·u = 0 and the conditions of walls and
// solids, and the values prescribed by sources.
#include "mac/grid/inflow.hpp"
#include "smoke/solver.hpp"

namespace weir::smoke {

/// Not editable: the velocity in scenes with bodies, whose motion is coupled to it, or with drag of ice; fields derived from the enthalpy.
template <int D>
std::vector<EditableField> FlowSolver<D>::editable() {
    std::vector<EditableField> list;
    if (!bodies_ && !heat_) {
        EditableField velocity{"", "velocity", {}};
        for (int a = 0; a < D; ++a) velocity.data.emplace_back(state_.u[a].values());
        list.push_back(std::move(velocity));
    }
    for (auto& field : state_.fields)
        if (!field.derived && !heat_) list.push_back({"", field.name, {field.values.values()}});
    return list;
}

/// The next step starts with the previous pressure: the pressure that projects the new velocity is not that of the flow.
template <int D>
void FlowSolver<D>::edited(const EditableField& field) {
    if (field.name != "velocity") return enforce_sources();
    set_side_faces(state_.u, state_.sides, state_.nu);
    sync_periodic(state_.u, state_.sides);
    solids_.set_faces(state_);
    const Grid<real, D> pressure = state_.p;
    state_.p.fill(0);
    projection_.project(state_, 1);
    state_.p = pressure;
    fastest_ = not_applicable;
}

template std::vector<EditableField> FlowSolver<2>::editable();
template std::vector<EditableField> FlowSolver<3>::editable();
template void FlowSolver<2>::edited(const EditableField&);
template void FlowSolver<3>::edited(const EditableField&);

}  // namespace weir::smoke
