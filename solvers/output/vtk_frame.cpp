#include "output/vtk_frame.hpp"

#include "output/frame_arrays.hpp"
#include "parallel/communicator.hpp"
#include "parallel/partition.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>
#include <type_traits>

namespace weir::output {

namespace {

/// Flags of cells hidden from VTK's filters: those in solids.
DataArray hidden(std::vector<std::uint8_t> solid, const Parts& tuples) {
    constexpr std::uint8_t hidden_cell = 32;  // vtkDataSetAttributes::HIDDENCELL
    return data_array<std::uint8_t>("vtkGhostType", 1, tuples,
                                    [solid = std::move(solid), first = tuples.begin(communicator().rank())](std::size_t i, int) {
                                        return solid[i - first] ? hidden_cell : std::uint8_t{0};
                                    });
}

/// The shortest text that reads back as the same double, in the format of VTK's attributes (and of ECMAScript): 0.000001, 1e-7, no -0.
std::string attribute_text(real value) {
    if (value == 0) return "0";
    const bool plain = 1e-6 <= std::abs(value) && std::abs(value) < 1e21;
    char text[40];
    std::string all(text,
                    std::to_chars(text, text + sizeof text, value, plain ? std::chars_format::fixed : std::chars_format::scientific).ptr);
    const std::size_t exponent = all.find('e');
    if (exponent != std::string::npos && all[exponent + 2] == '0') all.erase(exponent + 2, 1);
    return all;
}

std::string triple(const std::array<real, 3>& x) { return attribute_text(x[0]) + ' ' + attribute_text(x[1]) + ' ' + attribute_text(x[2]); }

/// An image with these numbers of points along each axis.
VtkFile image(const std::array<int, 3>& points, const std::array<real, 3>& origin, const std::array<real, 3>& spacing, real t) {
    std::string extent;
    for (std::size_t a = 0; a < 3; ++a) extent += (a > 0 ? " 0 " : "0 ") + std::to_string(points[a] - 1);
    return {.type = "ImageData",
            .version = "0.1",
            .attributes = " WholeExtent=\"" + extent + "\" Origin=\"" + triple(origin) + "\" Spacing=\"" + triple(spacing) +
                          "\" Direction=\"1 0 0 0 1 0 0 0 1\"",
            .piece = with_room("Extent", extent, 66),
            .time = t};
}

/// Between points or cells; in 2D the third axis has no extent.
std::array<real, 3> spacing_of(const GridView& grid) {
    return {grid.spacing[0], grid.spacing[1], grid.dim == 2 ? grid.spacing[0] : grid.spacing[2]};
}

/// The connectivity: number of cells, concatenated corners of all cells, and the end of each in that list.
struct Cells {
    Parts cells, corners;
    std::function<std::int64_t(std::size_t corner)> corner;
    std::function<std::int64_t(std::size_t cell)> end;
};

VtkElement element_of(const std::string& name, const Cells& cells) {
    VtkElement element{name, "", {}};
    element.arrays = {data_array<std::int64_t>("connectivity", 1, cells.corners, [f = cells.corner](std::size_t i, int) { return f(i); }),
                      data_array<std::int64_t>("offsets", 1, cells.cells, [f = cells.end](std::size_t i, int) { return f(i); })};
    for (DataArray& array : element.arrays) array.tells_extremes = false;
    return element;
}

Cells no_cells() { return {Parts::of_first(0), Parts::of_first(0), {}, {}}; }

/// A cell for every `corners` entries of the list.
Cells cells_of(const Parts& cells, std::size_t corners, std::function<std::int64_t(std::size_t)> corner) {
    Parts all = cells;
    for (std::size_t& begin : all.begins) begin *= corners;
    return {cells, all, std::move(corner), [corners](std::size_t cell) { return static_cast<std::int64_t>(corners * (cell + 1)); }};
}

Cells all_on_first(std::size_t cells, std::size_t corners, std::function<std::int64_t(std::size_t)> corner) {
    return cells_of(Parts::of_first(cells), corners, std::move(corner));
}

/// Quadrilaterals with rows of points as corners.
Cells quadrilaterals(const SheetView& sheet, const FieldSet& fields) {
    const auto nx = static_cast<std::size_t>(sheet.points[0]);
    return cells_of(parts_of_planes(fields, nx - 1, sheet.points[1] - 1), 4, [nx](std::size_t at) {
        const std::size_t cell = at / 4, i = cell % (nx - 1), k = cell / (nx - 1);
        const std::array<std::size_t, 4> corners{i + nx * k, i + nx * (k + 1), i + 1 + nx * (k + 1), i + 1 + nx * k};
        return static_cast<std::int64_t>(corners[at % 4]);
    });
}

/// Points with their data and connectivity.
VtkFile points(std::vector<DataArray> data, const std::string& attributes, DataArray position, const Cells& vertices, const Cells& lines,
               const Cells& polygons, real t) {
    const auto number = [](const std::string& name, std::size_t value) { return with_room(name, std::to_string(value)); };
    return {.type = "PolyData",
            .version = "0.1",
            .attributes = "",
            .piece = number("NumberOfPoints", position.tuples.all()) + number("NumberOfVerts", vertices.cells.all()) +
                     number("NumberOfLines", lines.cells.all()) + number("NumberOfStrips", 0) +
                     number("NumberOfPolys", polygons.cells.all()),
            .time = t,
            .elements = {{"PointData", attributes, std::move(data)},
                         {"CellData", "", {}},
                         {"Points", "", {std::move(position)}},
                         element_of("Verts", vertices),
                         element_of("Lines", lines),
                         element_of("Strips", no_cells()),
                         element_of("Polys", polygons)}};
}

}  // namespace

VtkFile image_of(const FieldSet& fields, real t, const FrameOptions& options) {
    const GridView& grid = fields.grid;
    std::array<real, 3> origin = grid.origin;
    if (grid.dim == 2) origin[2] = 0;
    VtkFile file = image({grid.cells[0] + 1, grid.cells[1] + 1, grid.dim == 2 ? 1 : grid.cells[2] + 1}, origin, spacing_of(grid), t);
    const Parts cells = parts_of_grid(fields, grid.cells);
    std::vector<DataArray> data = cell_arrays(fields, options);
    if (options.solid) {
        const int rank = communicator().rank();
        data.push_back(hidden(options.solid(fields, t, cells.begin(rank), cells.end(rank)), cells));
        file.version = "2.2";  // the first version with hidden cells
    }
    file.elements = {{"PointData", "", {}}, {"CellData", "", std::move(data)}};
    return file;
}

VtkFile face_image_of(const FieldSet& fields, int axis, real t, const FrameOptions& options) {
    const GridView& grid = fields.grid;
    std::array<int, 3> n = grid.cells;
    std::array<real, 3> first{};
    for (std::size_t a = 0; a < 3; ++a) first[a] = static_cast<int>(a) < grid.dim ? grid.origin[a] + 0.5 * grid.spacing[a] : 0;
    const auto along = static_cast<std::size_t>(axis);
    ++n[along];
    first[along] = grid.origin[along];
    const Parts faces = parts_of_grid(fields, n);
    std::vector<DataArray> data;
    for (const auto& field : fields.fields) {
        if (field.where != Where::face || !chosen(options, field)) continue;
        data.push_back(real_array(options, field.name + '_' + "xyz"[axis], 1, faces,
                                  [values = field.data[along]](std::size_t i, int) { return values[i]; }));
    }
    VtkFile file = image(n, first, spacing_of(grid), t);
    file.elements = {{"PointData", "", std::move(data)}, {"CellData", "", {}}};
    return file;
}

VtkFile particles_of(const FieldSet& fields, const std::string& set, real t, const FrameOptions& options) {
    const FieldView& position = *fields.find(set, "position");
    const std::size_t here = position.data[0].size();
    const auto sheet = std::find_if(fields.sheets.begin(), fields.sheets.end(), [&](const SheetView& s) { return s.set == set; });
    const bool has_rows = sheet != fields.sheets.end() && sheet->points[1] > 1;
    const Parts all = fields.particles_in_parts ? Parts{begins_of_ranks(here)}
                      : has_rows                ? parts_of_planes(fields, static_cast<std::size_t>(sheet->points[0]), sheet->points[1])
                                                : Parts::of_first(here);
    const std::size_t first = fields.particles_in_parts ? all.begin(communicator().rank()) : 0;
    std::vector<DataArray> data;
    for (const auto& field : fields.fields)
        if (field.set == set && field.name != "position" && chosen(options, field)) data.push_back(field_array(field, all, options, first));
    const auto itself = [](std::size_t i) { return static_cast<std::int64_t>(i); };
    Cells vertices = no_cells(), lines = no_cells(), polygons = no_cells();
    if (sheet == fields.sheets.end())
        vertices = cells_of(all, 1, itself);
    else if (has_rows)
        polygons = quadrilaterals(*sheet, fields);
    else
        lines = all_on_first(1, static_cast<std::size_t>(sheet->points[0]), itself);
    return points(std::move(data), "", field_array(position, all, options, first), vertices, lines, polygons, t);
}

VtkFile surface_of(const SurfaceMesh& mesh, real t, const FrameOptions& options) {
    const auto parts = [](const auto& list) { return Parts{begins_of_ranks(list.size())}; };
    const Parts all = parts(mesh.points);
    const auto vectors = [&](const char* name, const std::vector<Vec<3>>& list) {
        return real_array(options, name, 3, all, [&list, first = mesh.first](std::size_t i, int c) { return list[i - first][c]; });
    };
    std::vector<DataArray> data{vectors("Normals", mesh.normals)};
    if (parts(mesh.velocity).all() > 0) data.push_back(vectors("velocity", mesh.velocity));
    data.push_back(
        real_array(options, "thickness", 1, all, [&mesh, first = mesh.first](std::size_t i, int) { return mesh.thickness[i - first]; }));
    const auto cells = [&](const auto& list) {
        constexpr std::size_t corners = std::tuple_size_v<typename std::decay_t<decltype(list)>::value_type>;
        const Parts part = parts(list);
        return cells_of(part, corners, [&list, first = part.begin(communicator().rank())](std::size_t at) {
            return static_cast<std::int64_t>(list[at / corners - first][at % corners]);
        });
    };
    return points(std::move(data), " Normals=\"Normals\"", vectors("position", mesh.points), no_cells(), cells(mesh.lines),
                  cells(mesh.corners), t);
}

}  // namespace weir::output
