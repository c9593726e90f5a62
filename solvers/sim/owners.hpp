// Of the fields that a solver shows over ranks the part that this rank looks at (FieldSet::cut), and what comes of all parts.
#pragma once
#include "core/in_turn.hpp"
#include "core/owners.hpp"
#include "core/solver.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace weir::sim {

/// Planes of a component of a field along the slowest axis, or rows of a sheet; 1 where its entries are of no planes.
inline int planes_in(const FieldSet& fields, const FieldView& view, std::size_t component) {
    if (view.where == Where::particle) {
        const auto sheet = std::find_if(fields.sheets.begin(), fields.sheets.end(), [&](const SheetView& s) { return s.set == view.set; });
        return sheet == fields.sheets.end() ? 1 : sheet->points[1];
    }
    const auto axis = static_cast<std::size_t>(std::max(1, fields.grid.dim) - 1);
    return fields.grid.cells[axis] + (view.where == Where::face && component == axis ? 1 : 0);
}

/// Those of them that this rank looks at: its own, or all.
inline PlaneRange own_planes(const FieldSet& fields, const FieldView& view, std::size_t component) {
    const int planes = planes_in(fields, view, component);
    if (!fields.cut || planes == 1) return {0, planes};
    return {fields.cut->begin(slabs().rank()), fields.cut->end(slabs().rank(), planes)};
}

/// The entries there, [first, second).
inline std::pair<std::size_t, std::size_t> own_entries(const FieldSet& fields, const FieldView& view, std::size_t component) {
    if (!fields.cut) return {0, view.data[component].size()};
    const PlaneRange own = own_planes(fields, view, component);
    const std::size_t plane = view.data[component].size() / static_cast<std::size_t>(planes_in(fields, view, component));
    return {plane * static_cast<std::size_t>(own.begin), plane * static_cast<std::size_t>(own.end)};
}

/// The values of these.
inline std::span<const real> own_values(const FieldSet& fields, const FieldView& view, std::size_t component) {
    const auto [first, last] = own_entries(fields, view, component);
    return view.data[component].subspan(first, last - first);
}

/// Whether these are a part, to which others have the rest.
inline bool in_parts(const FieldSet& fields, const FieldView& view) {
    return (view.where == Where::particle && fields.particles_in_parts) || (fields.cut != nullptr && planes_in(fields, view, 0) > 1);
}

/// What comes of a value to which add(value) adds the entries of a field that this rank looks at; others theirs, in the order of one
/// process.
template <class T, class F>
T added_by_owners(const FieldSet& fields, const FieldView& view, T value, const F& add) {
    if (in_parts(fields, view)) return in_turn(value, add);
    add(value);
    return value;
}

/// What those of all ranks come to.
inline real largest_of_owners(const FieldSet& fields, real own) {
    if (!fields.cut) return own;
    const std::vector<real> all = of_ranks(own);
    return *std::max_element(all.begin(), all.end());
}

}  // namespace weir::sim
