#include "output/frame_arrays.hpp"

#include <algorithm>

namespace weir::output {

namespace {

/// The mean of the two faces across each axis.
DataArray at_centres(const FieldView& field, const GridView& grid, const Parts& tuples, const FrameOptions& options) {
    const auto nx = static_cast<std::size_t>(grid.cells[0]), ny = static_cast<std::size_t>(grid.cells[1]);
    return real_array(options, field.name, 3, tuples, [data = field.data, nx, ny](std::size_t i, int c) {
        if (c >= static_cast<int>(data.size())) return 0.0;
        const std::size_t x = i % nx, y = i / nx % ny, z = i / (nx * ny);
        const std::size_t wide = nx + (c == 0), high = ny + (c == 1);
        const std::size_t lower = x + wide * (y + high * z), step = c == 0 ? 1 : c == 1 ? wide : wide * high;
        const auto& face = data[static_cast<std::size_t>(c)];
        return 0.5 * (face[lower] + face[lower + step]);
    });
}

}  // namespace

bool chosen(const FrameOptions& options, const FieldView& field) {
    return options.fields.empty() || field.name == "position" ||
           std::find(options.fields.begin(), options.fields.end(), field.name) != options.fields.end();
}

bool has_grid_fields(const FieldSet& fields, const FrameOptions& options, bool faces_only) {
    return fields.grid.dim > 0 && std::any_of(fields.fields.begin(), fields.fields.end(), [&](const FieldView& field) {
               return field.where != Where::particle && (!faces_only || field.where == Where::face) && chosen(options, field);
           });
}

std::vector<std::string> particle_sets(const FieldSet& fields) {
    std::vector<std::string> sets;
    for (const auto& field : fields.fields)
        if (field.where == Where::particle && std::find(sets.begin(), sets.end(), field.set) == sets.end()) sets.push_back(field.set);
    return sets;
}

Parts parts_of_planes(const FieldSet& fields, std::size_t entries, int planes) {
    if (fields.cut == nullptr) return Parts::of_first(entries * static_cast<std::size_t>(planes));
    Parts parts{{0}};
    for (int rank = 0; rank < fields.cut->ranks(); ++rank)
        parts.begins.push_back(entries * static_cast<std::size_t>(fields.cut->end(rank, planes)));
    return parts;
}

Parts parts_of_grid(const FieldSet& fields, const std::array<int, 3>& n) {
    const auto slowest = static_cast<std::size_t>(std::max(1, fields.grid.dim) - 1);
    std::size_t plane = 1;
    for (std::size_t a = 0; a < slowest; ++a) plane *= static_cast<std::size_t>(n[a]);
    return parts_of_planes(fields, plane, n[slowest]);
}

DataArray field_array(const FieldView& field, const Parts& tuples, const FrameOptions& options, std::size_t first) {
    return real_array(options, field.name, field.components() == 1 ? 1 : 3, tuples, [data = field.data, first](std::size_t i, int c) {
        const auto at = static_cast<std::size_t>(c);
        return at < data.size() ? data[at][i - first] : 0.0;
    });
}

std::vector<DataArray> cell_arrays(const FieldSet& fields, const FrameOptions& options) {
    const Parts cells = parts_of_grid(fields, fields.grid.cells);
    std::vector<DataArray> arrays;
    for (const auto& field : fields.fields) {
        if (field.where == Where::particle || !chosen(options, field)) continue;
        arrays.push_back(field.where == Where::face ? at_centres(field, fields.grid, cells, options) : field_array(field, cells, options));
    }
    return arrays;
}

}  // namespace weir::output
