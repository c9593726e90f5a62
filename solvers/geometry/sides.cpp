#include "geometry/sides.hpp"
#include "scene/names.hpp"

#include <stdexcept>

namespace weir::geometry {

namespace {

SideKind kind_named(const std::string& name) {
    if (name == "wall") return SideKind::wall;
    if (name == "moving_wall") return SideKind::moving_wall;
    if (name == "inflow") return SideKind::inflow;
    if (name == "outflow" || name == "open") return SideKind::outflow;
    if (name == "periodic") return SideKind::periodic;
    throw std::logic_error("side \"" + name + "\" is in the schema but has no meaning");
}

template <int D>
Side<D> make_side(const scene::Table& table) {
    Side<D> side;
    side.kind = kind_named(table.text("kind"));
    side.no_slip = side.kind == SideKind::moving_wall || table.text_or("slip", "free") == "no";
    if (table.has("velocity")) side.velocity = table.vec<D>("velocity");
    side.profile = table.text_or("profile", "uniform");
    return side;
}

}  // namespace

template <int D>
Sides<D>::Sides(const scene::Scene& scene) {
    for (int axis = 0; axis < D; ++axis) {
        const std::string letter(1, "xyz"[axis]);
        for (int end = 0; end < 2; ++end) {
            const std::string path = scene::side_key(axis, end);
            if (scene.has(path)) side(axis, end) = make_side<D>(scene.root().table(path));
        }
        if (!scene.has("grid.periodic")) continue;
        for (const auto& name : scene.root().texts("grid.periodic"))
            if (name == letter) side(axis, 0).kind = side(axis, 1).kind = SideKind::periodic;
    }
}

template <int D>
void Sides<D>::read(const scene::Scene& scene, const std::string& field) {
    for (int axis = 0; axis < D; ++axis)
        for (int end = 0; end < 2; ++end)
            if (const auto path = scene::side_key(axis, end) + "." + field; scene.has(path))
                (field == "temperature" ? side(axis, end).temperature : side(axis, end).smoke) = scene.number(path);
}

template class Sides<2>;
template class Sides<3>;

}  // namespace weir::geometry
