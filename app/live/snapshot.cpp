#include "app/live/snapshot.hpp"

#include "rigid/bodies.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace weir::live {

namespace {

std::string array_of(const std::string& field) { return field == "speed" ? "velocity" : field; }

/// The particle set that stands for the fluid, or nullptr.
const FieldView* positions_of(const FieldSet& fields) {
    for (const auto& f : fields.fields)
        if (f.where == Where::particle && f.name == "position" && f.set != rigid::body_set_name) return &f;
    return nullptr;
}

float length(const FieldView& f, std::size_t i) {
    if (f.data.size() == 1) return static_cast<float>(f.data[0][i]);
    real sum = 0;
    for (const auto& component : f.data) sum += component[i] * component[i];
    return static_cast<float>(std::sqrt(sum));
}

/// Of faces, the length of their means in each cell.
void speeds(const FieldView& faces, const GridView& grid, std::vector<float>& to) {
    const auto n = grid.cells;
    parallel_for(0, n[2], [&](int k) {
        for (int j = 0; j < n[1]; ++j)
            for (int i = 0; i < n[0]; ++i) {
                real sum = 0;
                for (std::size_t a = 0; a < faces.data.size(); ++a) {
                    const std::size_t w = static_cast<std::size_t>(n[0] + (a == 0)), h = static_cast<std::size_t>(n[1] + (a == 1));
                    const std::size_t at =
                        static_cast<std::size_t>(i) + w * (static_cast<std::size_t>(j) + h * static_cast<std::size_t>(k));
                    const std::size_t step = a == 0 ? 1 : a == 1 ? w : w * h;
                    const real mean = 0.5 * (faces.data[a][at] + faces.data[a][at + step]);
                    sum += mean * mean;
                }
                const auto cell = static_cast<std::size_t>(i) +
                                  static_cast<std::size_t>(n[0]) * (static_cast<std::size_t>(j) + static_cast<std::size_t>(n[1] * k));
                to[cell] = static_cast<float>(std::sqrt(sum));
            }
    });
}

void take_points(const FieldSet& fields, const FieldView& x, const std::string& array, Snapshot& into) {
    const std::size_t count = x.data[0].size();
    into.points.resize(3 * count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t a = 0; a < 3; ++a) into.points[3 * i + a] = a < x.data.size() ? static_cast<float>(x.data[a][i]) : 0;
    const FieldView* f = fields.find(x.set, array);
    into.of_points.resize(f ? count : 0);
    for (std::size_t i = 0; f && i < count; ++i) into.of_points[i] = length(*f, i);
}

void take_cells(const FieldSet& fields, const std::string& array, Snapshot& into) {
    const auto& n = into.cells = fields.grid.cells;
    const FieldView* f = fields.find("", array);
    const auto cells = static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
    into.of_cells.resize(f ? cells : 0);
    if (!f) return;
    if (f->where == Where::face) return speeds(*f, fields.grid, into.of_cells);
    for (std::size_t i = 0; i < cells; ++i) into.of_cells[i] = length(*f, i);
}

}  // namespace

std::vector<std::string> field_names(const FieldSet& fields) {
    std::vector<std::string> names;
    for (const auto& f : fields.fields) {
        const std::string name = f.name == "velocity" ? "speed" : f.name;
        if (name != "position" && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
}

std::string first_field(const FieldSet& fields) {
    const auto names = field_names(fields);
    for (const char* name : {"smoke", "temperature", "speed"})
        if (std::find(names.begin(), names.end(), name) != names.end()) return name;
    return names.empty() ? "" : names.front();
}

void take_fields(const FieldSet& fields, const std::string& field, Snapshot& into) {
    const std::string array = array_of(field);
    into.field = field;
    into.points.clear(), into.of_points.clear(), into.of_cells.clear(), into.heights.clear();
    for (const auto& f : fields.fields)
        if (f.set == rigid::body_set_name) {
            auto& components = into.bodies[f.name];
            components.clear();
            for (const auto& values : f.data) components.emplace_back(values.begin(), values.end());
        }
    const FieldView* x = positions_of(fields);
    if (x) take_points(fields, *x, array, into);
    const FieldView* surface = fields.find("", surface_height_name);
    if (surface && fields.grid.cells[1] == 1) into.heights.assign(surface->data[0].begin(), surface->data[0].end());
    if (!x || into.of_points.empty()) take_cells(fields, array, into);  // a grid behind particles only where it says more than they do
}

}  // namespace weir::live
