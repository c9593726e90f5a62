#include "output/frame_files.hpp"

#include "parallel/communicator.hpp"
#include "parallel/partition.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>
#include <type_traits>

namespace weir::output {

namespace {

template <class Value>
DataArray real_array(const FrameOptions& options, std::string name, int components, const Parts& tuples, Value value) {
    if (options.single_precision) return data_array<float>(std::move(name), components, tuples, std::move(value));
    return data_array<double>(std::move(name), components, tuples, std::move(value));
}

/// Vectors have three components in VTK for any dimension: the third is zero in 2D.
int vtk_components(const FieldView& field) { return field.components() == 1 ? 1 : 3; }

/// The elements of a field; for a part of the particles, starting at global index `first`.
DataArray as_it_is(const FieldView& field, const Parts& tuples, const FrameOptions& options, std::size_t first = 0) {
    return real_array(options, field.name, vtk_components(field), tuples, [data = field.data, first](std::size_t i, int c) {
        const auto at = static_cast<std::size_t>(c);
        return at < data.size() ? data[at][i - first] : 0.0;
    });
}

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

/// The partition of the planes of an array, with `entries` elements per plane; all on rank 0, where all ranks store whole fields.
Parts parts_of_planes(const FieldSet& fields, std::size_t entries, int planes) {
    if (fields.cut == nullptr) return Parts::of_first(entries * static_cast<std::size_t>(planes));
    Parts parts{{0}};
    for (int rank = 0; rank < fields.cut->ranks(); ++rank)
        parts.begins.push_back(entries * static_cast<std::size_t>(fields.cut->end(rank, planes)));
    return parts;
}

/// The same for an array with these extents.
Parts parts_of_grid(const FieldSet& fields, const std::array<int, 3>& n) {
    const auto slowest = static_cast<std::size_t>(std::max(1, fields.grid.dim) - 1);
    std::size_t plane = 1;
    for (std::size_t a = 0; a < slowest; ++a) plane *= static_cast<std::size_t>(n[a]);
    return parts_of_planes(fields, plane, n[slowest]);
}

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

bool chosen(const FrameOptions& options, const FieldView& field) {
    return options.fields.empty() || field.name == "position" ||
           std::find(options.fields.begin(), options.fields.end(), field.name) != options.fields.end();
}

VtkFile image_of(const FieldSet& fields, real t, const FrameOptions& options) {
    const GridView& grid = fields.grid;
    std::array<real, 3> origin = grid.origin;
    if (grid.dim == 2) origin[2] = 0;
    VtkFile file = image({grid.cells[0] + 1, grid.cells[1] + 1, grid.dim == 2 ? 1 : grid.cells[2] + 1}, origin, spacing_of(grid), t);
    const Parts cells = parts_of_grid(fields, grid.cells);
    std::vector<DataArray> data;
    for (const auto& field : fields.fields) {
        if (field.where == Where::particle || !chosen(options, field)) continue;
        data.push_back(field.where == Where::face ? at_centres(field, grid, cells, options) : as_it_is(field, cells, options));
    }
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
        if (field.set == set && field.name != "position" && chosen(options, field)) data.push_back(as_it_is(field, all, options, first));
    const auto itself = [](std::size_t i) { return static_cast<std::int64_t>(i); };
    Cells vertices = no_cells(), lines = no_cells(), polygons = no_cells();
    if (sheet == fields.sheets.end())
        vertices = cells_of(all, 1, itself);
    else if (has_rows)
        polygons = quadrilaterals(*sheet, fields);
    else
        lines = all_on_first(1, static_cast<std::size_t>(sheet->points[0]), itself);
    return points(std::move(data), "", as_it_is(position, all, options, first), vertices, lines, polygons, t);
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
