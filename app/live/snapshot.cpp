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
        if (f.where == Where::particle && f.name == "position" && f.set != rigid::body_set_name && f.set != box_set_name) return &f;
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

void take_bodies(const FieldSet& fields, Snapshot& into) {
    for (const auto& f : fields.fields)
        if (f.set == rigid::body_set_name) {
            auto& components = into.bodies[f.name];
            components.clear();
            for (const auto& values : f.data) components.emplace_back(values.begin(), values.end());
        }
    into.boxes.clear();
    const FieldView *at = fields.find(box_set_name, "position"), *size = fields.find(box_set_name, "size");
    for (std::size_t b = 0; at && size && b < at->data[0].size(); ++b) {
        view::FloatingBox box{};
        for (std::size_t a = 0; a < at->data.size(); ++a) box.middle[a] = at->data[a][b], box.size[a] = size->data[a][b];
        into.boxes.push_back(box);
    }
}

/// Columns on their bed, or a liquid that a level set alone tells of; in place of the grid's cells.
void take_water(const FieldSet& fields, bool has_points, Snapshot& into) {
    into.columns.nx = 0, into.level.phi.clear();
    const GridView& grid = fields.grid;
    const auto list = [](const FieldView& f, std::vector<float>& to) { to.assign(f.data[0].begin(), f.data[0].end()); };
    const FieldView *depth = fields.find("", column_depth_name), *bed = fields.find("", "bed"), *phi = fields.find("", level_set_name);
    if (depth && bed && grid.cells[1] == 1) {
        view::Columns& c = into.columns;
        c.nx = grid.cells[0], c.nz = grid.cells[2];
        c.dx = grid.spacing[0], c.dz = grid.spacing[2], c.x0 = grid.origin[0], c.z0 = grid.origin[2];
        list(*depth, c.depth), list(*bed, c.bed);
        c.values = into.of_cells;
    } else if (phi && !has_points) {
        view::Level& level = into.level;
        level.cells = grid.cells;
        for (std::size_t a = 0; a < 3; ++a) level.origin[a] = grid.origin[a], level.spacing[a] = grid.spacing[a];
        list(*phi, level.phi);
        level.values = into.of_cells;
        if (const FieldView* tall = fields.find("", "cell_height"))
            list(*tall, level.heights);
        else
            level.heights.clear();
    }
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

void take_fields(const FieldSet& fields, const std::string& field, Snapshot& into) {
    const std::string array = array_of(field);
    into.field = field;
    into.points.clear(), into.of_points.clear(), into.of_cells.clear(), into.sheet = {0, 0};
    take_bodies(fields, into);
    const FieldView* x = positions_of(fields);
    if (x) take_points(fields, *x, array, into);
    for (const auto& sheet : fields.sheets)
        if (x && sheet.set == x->set) into.sheet = sheet.points;
    if (!x || into.of_points.empty()) take_cells(fields, array, into);  // a grid behind particles only where it says more than they do
    take_water(fields, x != nullptr, into);
}

}  // namespace weir::live
