#include "mac/grid/state.hpp"

#include "parallel/plane_checkpoint.hpp"

#include <stdexcept>

namespace weir::mac {

namespace {

constexpr const char* component_names[] = {"u_x", "u_y", "u_z"};

template <class Fields>
auto find_in(Fields& fields, std::string_view name) -> decltype(&fields.front().values) {
    for (auto& field : fields)
        if (field.name == name) return &field.values;
    return nullptr;
}

/// The effect, and the exact solution that depends on it.
template <int D>
bool asks_for_viscosity(const scene::Scene& scene, const geometry::Sides<D>& sides) {
    bool asks = scene.effect("viscosity") != nullptr || scene.root().text_or("initial.velocity.name", "") == "kovasznay";
    for (int a = 0; a < D; ++a) asks = asks || sides.side(a, 0).profile == "kovasznay" || sides.side(a, 1).profile == "kovasznay";
    return asks;
}

}  // namespace

template <int D>
Lattice<D>::Lattice(const scene::Scene& scene) : cells(scene.index<D>("grid.cells")) {
    const Vec<D> size = scene.vec<D>("grid.size");
    if (scene.has("grid.origin")) origin = scene.vec<D>("grid.origin");
    for (int d = 0; d < D; ++d) h[d] = size[d] / cells[d];
}

template <int D>
MacState<D>::MacState(const scene::Scene& scene, const FieldPlan& plan, const Slab* slab) : sides(scene) {
    const Lattice<D> lattice(scene);
    u = MacVelocity<D>(Extent<D>(lattice.cells, OwnPlanes(slab)), lattice.h, lattice.origin);
    p = Grid<real, D>(u.cells);
    cells = Grid<poisson::Cell, D>(u.cells, poisson::Cell::fluid);
    for (const auto& name : plan.advected_fields()) {
        if (name == "temperature" || name == "smoke") sides.read(scene, name);
        fields.push_back({name, Grid<real, D>(u.cells), {}, field_boundary(sides, name)});
    }
    for (const auto& name : plan.scratch_fields()) scratch.push_back({name, Grid<real, D>(u.cells), {}, {}});
    rho = scene.root().number_or("fluid.density", rho);
    if (asks_for_viscosity(scene, sides)) nu = scene.number("fluid.viscosity");
    for (int a = 0; a < D; ++a) boundary[static_cast<std::size_t>(a)] = velocity_boundary(sides, u, a, nu);
}

template <int D>
Grid<real, D>* MacState<D>::find(std::string_view name) {
    return find_in(fields, name);
}

template <int D>
const Grid<real, D>* MacState<D>::find(std::string_view name) const {
    return find_in(fields, name);
}

template <int D>
NamedField<D>& MacState<D>::field(std::string_view name) {
    for (auto& field : fields)
        if (field.name == name) return field;
    throw std::logic_error("no effect requested the field \"" + std::string(name) + "\"");
}

template <int D>
Grid<real, D>& MacState<D>::scratch_field(std::string_view name) {
    if (auto* field = find_in(scratch, name)) return *field;
    throw std::logic_error("no effect requested the scratch field \"" + std::string(name) + "\"");
}

template <int D>
void MacState<D>::allocate_solids() {
    for (int a = 0; a < D; ++a) {
        solid.open[static_cast<std::size_t>(a)] = Grid<real, D>(u[a].extent(), 1);
        solid.velocity[static_cast<std::size_t>(a)] = Grid<real, D>(u[a].extent());
    }
}

template <int D>
void MacState<D>::save(Checkpoint& to) const {
    for (int a = 0; a < D; ++a) put_planes(to, component_names[a], u[a]);
    put_planes(to, "p", p);
    put_planes(to, "cells", cells);
    for (const auto& field : fields) put_planes(to, "field." + field.name, field.values);
    to.put_value("time", time);
}

template <int D>
void MacState<D>::restore(const Checkpoint& from) {
    for (int a = 0; a < D; ++a) get_planes(from, component_names[a], u[a]);
    get_planes(from, "p", p);
    get_planes(from, "cells", cells);
    for (auto& field : fields) get_planes(from, "field." + field.name, field.values);
    time = from.template get_value<real>("time");
}

template <int D>
std::size_t MacState<D>::bytes() const {
    std::size_t total = u.bytes() + p.bytes() + cells.bytes();
    for (const auto& grid : solid.open) total += 2 * grid.bytes();
    for (const auto& grid : mobility) total += grid.bytes();
    for (const auto& field : fields) total += field.values.bytes() + field.before.bytes() + field.held.size() * sizeof(Held);
    for (const auto& component : before.face) total += component.bytes();
    for (const auto& field : scratch) total += field.values.bytes();
    return total;
}

template struct Lattice<2>;
template struct Lattice<3>;
template struct MacState<2>;
template struct MacState<3>;

}  // namespace weir::mac
