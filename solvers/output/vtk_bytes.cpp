#include "output/vtk_bytes.hpp"

#include "core/error.hpp"

#include <algorithm>

#ifdef WEIR_HAS_VTK
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#endif

namespace weir::output {

bool chosen(const FrameOptions& options, const FieldView& field) {
    return options.fields.empty() || field.name == "position" ||
           std::find(options.fields.begin(), options.fields.end(), field.name) != options.fields.end();
}

#ifdef WEIR_HAS_VTK

namespace {

/// An array of `tuples` whose entry (i, c) is value(i, c).
template <class Array, class Value>
vtkSmartPointer<vtkDataArray> filled(const std::string& name, std::size_t tuples, int components, const Value& value) {
    auto array = vtkSmartPointer<Array>::New();
    array->SetName(name.c_str());
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
    auto* out = array->GetPointer(0);
    for (std::size_t i = 0; i < tuples; ++i)
        for (int c = 0; c < components; ++c) *out++ = static_cast<typename Array::ValueType>(value(i, c));
    return array;
}

template <class Value>
vtkSmartPointer<vtkDataArray> make_array(const FrameOptions& options, const std::string& name, std::size_t tuples, int components,
                                         const Value& value) {
    if (options.single_precision) return filled<vtkFloatArray>(name, tuples, components, value);
    return filled<vtkDoubleArray>(name, tuples, components, value);
}

/// Vectors have three components in VTK whatever the dimension: the third is zero in 2D.
int vtk_components(const FieldView& field) { return field.components() == 1 ? 1 : 3; }

vtkSmartPointer<vtkDataArray> as_it_is(const FieldView& field, const FrameOptions& options) {
    return make_array(options, field.name, field.data[0].size(), vtk_components(field),
                      [&](std::size_t i, int c) { return c < field.components() ? field.data[static_cast<std::size_t>(c)][i] : 0.0; });
}

/// The mean of the two faces across each axis.
vtkSmartPointer<vtkDataArray> at_centres(const FieldView& field, const GridView& grid, const FrameOptions& options) {
    const auto nx = static_cast<std::size_t>(grid.cells[0]), ny = static_cast<std::size_t>(grid.cells[1]);
    const std::size_t cells = nx * ny * static_cast<std::size_t>(grid.cells[2]);
    return make_array(options, field.name, cells, 3, [&](std::size_t i, int c) {
        if (c >= field.components()) return 0.0;
        const std::size_t x = i % nx, y = i / nx % ny, z = i / (nx * ny);
        const std::size_t wide = nx + (c == 0), high = ny + (c == 1);
        const std::size_t lower = x + wide * (y + high * z), step = c == 0 ? 1 : c == 1 ? wide : wide * high;
        const auto& face = field.data[static_cast<std::size_t>(c)];
        return 0.5 * (face[lower] + face[lower + step]);
    });
}

void stamp(vtkDataObject& data, real t) {
    vtkNew<vtkDoubleArray> time;
    time->SetName("TimeValue");  // the name by which ParaView finds it
    time->InsertNextValue(t);
    data.GetFieldData()->AddArray(time);
}

/// Cells that VTK's filters leave out.
vtkSmartPointer<vtkUnsignedCharArray> hidden(const std::vector<std::uint8_t>& solid) {
    auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
    array->SetName(vtkDataSetAttributes::GhostArrayName());
    for (const std::uint8_t one : solid) array->InsertNextValue(one ? vtkDataSetAttributes::HIDDENCELL : 0);
    return array;
}

template <class Writer>
std::string bytes_of(vtkDataObject* data, const FrameOptions& options) {
    vtkNew<Writer> writer;
    writer->SetInputData(data);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    if (options.compression == Compression::none) writer->SetCompressorTypeToNone();
    if (options.compression == Compression::lz4) writer->SetCompressorTypeToLZ4();
    if (options.compression == Compression::zlib) {
        writer->SetCompressorTypeToZLib();
        writer->SetCompressionLevel(1);  // higher levels take several times as long on noise-like doubles, for a few per cent
    }
    writer->WriteToOutputStringOn();
    if (!writer->Write()) throw OutputError("VTK could not encode a frame");
    return writer->GetOutputString();
}

/// Cells (or, for faces, points) of the grid; empty of data.
vtkSmartPointer<vtkImageData> image(const GridView& grid) {
    auto data = vtkSmartPointer<vtkImageData>::New();
    const bool flat = grid.dim == 2;
    data->SetDimensions(grid.cells[0] + 1, grid.cells[1] + 1, flat ? 1 : grid.cells[2] + 1);
    data->SetOrigin(grid.origin[0], grid.origin[1], flat ? 0 : grid.origin[2]);
    data->SetSpacing(grid.spacing[0], grid.spacing[1], flat ? grid.spacing[0] : grid.spacing[2]);
    return data;
}

/// A vertex a point.
void draw_points(vtkPolyData& data) {
    vtkNew<vtkCellArray> vertices;
    for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) vertices->InsertNextCell(1, &i);
    data.SetVerts(vertices);
}

/// Rows of points as the corners of quadrilaterals; a single row as a line.
void join(vtkPolyData& data, const SheetView& sheet) {
    const vtkIdType nx = sheet.points[0], nz = sheet.points[1];
    vtkNew<vtkCellArray> cells;
    if (nz == 1) {
        cells->InsertNextCell(static_cast<int>(nx));
        for (vtkIdType i = 0; i < nx; ++i) cells->InsertCellPoint(i);
        return data.SetLines(cells);
    }
    for (vtkIdType k = 0; k + 1 < nz; ++k)
        for (vtkIdType i = 0; i + 1 < nx; ++i) {
            const std::array<vtkIdType, 4> corners{i + nx * k, i + nx * (k + 1), i + 1 + nx * (k + 1), i + 1 + nx * k};
            cells->InsertNextCell(4, corners.data());
        }
    data.SetPolys(cells);
}

}  // namespace

bool can_write_frames() { return true; }

std::string image_bytes(const FieldSet& fields, real t, const FrameOptions& options) {
    const auto data = image(fields.grid);
    for (const auto& field : fields.fields) {
        if (field.where == Where::particle || !chosen(options, field)) continue;
        data->GetCellData()->AddArray(field.where == Where::face ? at_centres(field, fields.grid, options) : as_it_is(field, options));
    }
    if (options.solid) data->GetCellData()->AddArray(hidden(options.solid(fields, t)));
    stamp(*data, t);
    return bytes_of<vtkXMLImageDataWriter>(data, options);
}

std::string face_image_bytes(const FieldSet& fields, int axis, real t, const FrameOptions& options) {
    const GridView& grid = fields.grid;
    const auto data = image(grid);
    std::array<int, 3> n = grid.cells;
    std::array<real, 3> first{};
    for (std::size_t a = 0; a < 3; ++a) first[a] = static_cast<int>(a) < grid.dim ? grid.origin[a] + 0.5 * grid.spacing[a] : 0;
    const auto along = static_cast<std::size_t>(axis);
    ++n[along];
    first[along] = grid.origin[along];
    data->SetDimensions(n[0], n[1], n[2]);
    data->SetOrigin(first[0], first[1], first[2]);
    for (const auto& field : fields.fields) {
        if (field.where != Where::face || !chosen(options, field)) continue;
        const auto& values = field.data[along];
        data->GetPointData()->AddArray(
            make_array(options, field.name + '_' + "xyz"[axis], values.size(), 1, [&](std::size_t i, int) { return values[i]; }));
    }
    stamp(*data, t);
    return bytes_of<vtkXMLImageDataWriter>(data, options);
}

std::string particle_bytes(const FieldSet& fields, const std::string& set, real t, const FrameOptions& options) {
    const FieldView& position = *fields.find(set, "position");
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPoints> points;
    points->SetData(as_it_is(position, options));
    data->SetPoints(points);
    const auto sheet = std::find_if(fields.sheets.begin(), fields.sheets.end(), [&](const SheetView& s) { return s.set == set; });
    if (sheet != fields.sheets.end())
        join(*data, *sheet);
    else
        draw_points(*data);
    for (const auto& field : fields.fields)
        if (field.set == set && field.name != "position" && chosen(options, field))
            data->GetPointData()->AddArray(as_it_is(field, options));
    stamp(*data, t);
    return bytes_of<vtkXMLPolyDataWriter>(data, options);
}

std::string surface_bytes(const SurfaceMesh& mesh, real t, const FrameOptions& options) {
    const auto vectors = [&](const char* name, const std::vector<Vec<3>>& list) {
        return make_array(options, name, list.size(), 3, [&](std::size_t i, int c) { return list[i][c]; });
    };
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPoints> points;
    points->SetData(vectors("position", mesh.points));
    data->SetPoints(points);
    vtkNew<vtkCellArray> triangles;
    triangles->AllocateExact(static_cast<vtkIdType>(mesh.corners.size()), static_cast<vtkIdType>(3 * mesh.corners.size()));
    for (const auto& corners : mesh.corners) triangles->InsertNextCell({corners[0], corners[1], corners[2]});
    data->SetPolys(triangles);
    vtkNew<vtkCellArray> lines;
    lines->AllocateExact(static_cast<vtkIdType>(mesh.lines.size()), static_cast<vtkIdType>(2 * mesh.lines.size()));
    for (const auto& ends : mesh.lines) lines->InsertNextCell({ends[0], ends[1]});
    if (!mesh.lines.empty()) data->SetLines(lines);
    data->GetPointData()->SetNormals(vectors("Normals", mesh.normals));
    if (!mesh.velocity.empty()) data->GetPointData()->AddArray(vectors("velocity", mesh.velocity));
    data->GetPointData()->AddArray(
        make_array(options, "thickness", mesh.thickness.size(), 1, [&](std::size_t i, int) { return mesh.thickness[i]; }));
    stamp(*data, t);
    return bytes_of<vtkXMLPolyDataWriter>(data, options);
}

#else

namespace {
[[noreturn]] void without_vtk() { throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and writes no frames"); }
}  // namespace

bool can_write_frames() { return false; }
std::string image_bytes(const FieldSet&, real, const FrameOptions&) { without_vtk(); }
std::string face_image_bytes(const FieldSet&, int, real, const FrameOptions&) { without_vtk(); }
std::string particle_bytes(const FieldSet&, const std::string&, real, const FrameOptions&) { without_vtk(); }
std::string surface_bytes(const SurfaceMesh&, real, const FrameOptions&) { without_vtk(); }

#endif

}  // namespace weir::output
