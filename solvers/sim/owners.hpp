// The part of a solver's fields that this rank reads in parallel (FieldSet::cut), and reductions over all parts.
#pragma once
#include "core/solver.hpp"
#include "parallel/ownership.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace weir::sim {

/// Number of planes of a field component along the slowest axis, or rows of a sheet; 1 where the entries are not arranged in planes.
inline int planes_in(const FieldSet& fields, const FieldView& view, std::size_t component) {
    if (view.where == Where::particle) {
        const auto sheet = std::find_if(fields.sheets.begin(), fields.sheets.end(), [&](const SheetView& s) { return s.set == view.set; });
        return sheet == fields.sheets.end() ? 1 : sheet->points[1];
    }
    const auto axis = static_cast<std::size_t>(std::max(1, fields.grid.dim) - 1);
    return fields.grid.cells[axis] + (view.where == Where::face && component == axis ? 1 : 0);
}

/// The planes that this rank reads: its own, or all.
inline PlaneRange own_planes(const FieldSet& fields, const FieldView& view, std::size_t component) {
    const int planes = planes_in(fields, view, component);
    if (!fields.cut || planes == 1) return {0, planes};
    return {fields.cut->begin(communicator().rank()), fields.cut->end(communicator().rank(), planes)};
}

/// The range of their entries, [first, second).
inline std::pair<std::size_t, std::size_t> own_entries(const FieldSet& fields, const FieldView& view, std::size_t component) {
    if (!fields.cut) return {0, view.data[component].size()};
    const PlaneRange own = own_planes(fields, view, component);
    const std::size_t plane = view.data[component].size() / static_cast<std::size_t>(planes_in(fields, view, component));
    return {plane * static_cast<std::size_t>(own.begin), plane * static_cast<std::size_t>(own.end)};
}

/// The values of these entries.
inline std::span<const real> own_values(const FieldSet& fields, const FieldView& view, std::size_t component) {
    const auto [first, last] = own_entries(fields, view, component);
    return view.data[component].subspan(first, last - first);
}

/// Returns whether these entries are a part, and other ranks have the rest.
inline bool in_parts(const FieldSet& fields, const FieldView& view) {
    return (view.where == Where::particle && fields.particles_in_parts) || (fields.cut != nullptr && planes_in(fields, view, 0) > 1);
}

/// Sum over the ranks: `here` is that of the entries of a field that this rank reads. Its add() must not depend on the order.
template <class Sum>
Sum sum_of_owners(const FieldSet& fields, const FieldView& view, const Sum& here) {
    if (!in_parts(fields, view)) return here;
    Sum all{};
    for (const Sum& of_rank : of_ranks(here)) all.add(of_rank);
    return all;
}

/// Maximum over the ranks.
inline real largest_of_owners(const FieldSet& fields, real own) {
    if (!fields.cut) return own;
    const std::vector<real> all = of_ranks(own);
    return *std::max_element(all.begin(), all.end());
}

}  // namespace weir::sim
