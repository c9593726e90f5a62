// A frame's files as VTK's own writers make them, from the whole fields of one process: what ours are compared with.
#pragma once
#include "core/solver.hpp"
#include "core/surface_mesh.hpp"
#include "output/frames.hpp"

#include <algorithm>
#include <string>

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

namespace weir::test {

class VtkWriter {
public:
    explicit VtkWriter(output::FrameOptions options) : options_(std::move(options)) {}

    std::string image(const FieldSet& fields, real t) const {
        const auto data = grid(fields.grid);
        for (const auto& field : fields.fields) {
            if (field.where == Where::particle) continue;
            data->GetCellData()->AddArray(field.where == Where::face ? at_centres(field, fields.grid) : as_it_is(field));
        }
        if (options_.solid) {
            const std::vector<std::uint8_t> solid = options_.solid(fields, t, 0, static_cast<std::size_t>(data->GetNumberOfCells()));
            vtkNew<vtkUnsignedCharArray> hidden;
            hidden->SetName(vtkDataSetAttributes::GhostArrayName());
            for (const std::uint8_t one : solid) hidden->InsertNextValue(one ? vtkDataSetAttributes::HIDDENCELL : 0);
            data->GetCellData()->AddArray(hidden);
        }
        return bytes_of<vtkXMLImageDataWriter>(data, t);
    }

    std::string faces(const FieldSet& fields, int axis, real t) const {
        const GridView& view = fields.grid;
        const auto data = grid(view);
        std::array<int, 3> n = view.cells;
        std::array<real, 3> first{};
        for (std::size_t a = 0; a < 3; ++a) first[a] = static_cast<int>(a) < view.dim ? view.origin[a] + 0.5 * view.spacing[a] : 0;
        const auto along = static_cast<std::size_t>(axis);
        ++n[along], first[along] = view.origin[along];
        data->SetDimensions(n[0], n[1], n[2]);
        data->SetOrigin(first[0], first[1], first[2]);
        for (const auto& field : fields.fields) {
            if (field.where != Where::face) continue;
            const auto& values = field.data[along];
            data->GetPointData()->AddArray(
                array(field.name + '_' + "xyz"[axis], values.size(), 1, [&](std::size_t i, int) { return values[i]; }));
        }
        return bytes_of<vtkXMLImageDataWriter>(data, t);
    }

    std::string particles(const FieldSet& fields, const std::string& set, real t) const {
        vtkNew<vtkPolyData> data;
        vtkNew<vtkPoints> points;
        points->SetData(as_it_is(*fields.find(set, "position")));
        data->SetPoints(points);
        const auto sheet = std::find_if(fields.sheets.begin(), fields.sheets.end(), [&](const SheetView& s) { return s.set == set; });
        if (sheet != fields.sheets.end())
            join(*data, *sheet);
        else
            draw_points(*data);
        for (const auto& field : fields.fields)
            if (field.set == set && field.name != "position") data->GetPointData()->AddArray(as_it_is(field));
        return bytes_of<vtkXMLPolyDataWriter>(data, t);
    }

    std::string surface(const SurfaceMesh& mesh, real t) const {
        const auto vectors = [&](const char* name, const std::vector<Vec<3>>& list) {
            return array(name, list.size(), 3, [&](std::size_t i, int c) { return list[i][c]; });
        };
        vtkNew<vtkPolyData> data;
        vtkNew<vtkPoints> points;
        points->SetData(vectors("position", mesh.points));
        data->SetPoints(points);
        vtkNew<vtkCellArray> triangles, lines;
        for (const auto& corners : mesh.corners) triangles->InsertNextCell({corners[0], corners[1], corners[2]});
        data->SetPolys(triangles);
        for (const auto& ends : mesh.lines) lines->InsertNextCell({ends[0], ends[1]});
        if (!mesh.lines.empty()) data->SetLines(lines);
        data->GetPointData()->SetNormals(vectors("Normals", mesh.normals));
        if (!mesh.velocity.empty()) data->GetPointData()->AddArray(vectors("velocity", mesh.velocity));
        data->GetPointData()->AddArray(array("thickness", mesh.thickness.size(), 1, [&](std::size_t i, int) { return mesh.thickness[i]; }));
        return bytes_of<vtkXMLPolyDataWriter>(data, t);
    }

private:
    /// Entry (i, c) is value(i, c).
    template <class Array, class Value>
    static vtkSmartPointer<vtkDataArray> filled(const std::string& name, std::size_t tuples, int components, const Value& value) {
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
    vtkSmartPointer<vtkDataArray> array(const std::string& name, std::size_t tuples, int components, const Value& value) const {
        if (options_.single_precision) return filled<vtkFloatArray>(name, tuples, components, value);
        return filled<vtkDoubleArray>(name, tuples, components, value);
    }
    vtkSmartPointer<vtkDataArray> as_it_is(const FieldView& field) const {
        return array(field.name, field.data[0].size(), field.components() == 1 ? 1 : 3,
                     [&](std::size_t i, int c) { return c < field.components() ? field.data[static_cast<std::size_t>(c)][i] : 0.0; });
    }
    vtkSmartPointer<vtkDataArray> at_centres(const FieldView& field, const GridView& view) const {
        const auto nx = static_cast<std::size_t>(view.cells[0]), ny = static_cast<std::size_t>(view.cells[1]);
        return array(field.name, nx * ny * static_cast<std::size_t>(view.cells[2]), 3, [&](std::size_t i, int c) {
            if (c >= field.components()) return 0.0;
            const std::size_t wide = nx + (c == 0), high = ny + (c == 1), step = c == 0 ? 1 : c == 1 ? wide : wide * high;
            const std::size_t lower = i % nx + wide * (i / nx % ny + high * (i / (nx * ny)));
            const auto& face = field.data[static_cast<std::size_t>(c)];
            return 0.5 * (face[lower] + face[lower + step]);
        });
    }
    static vtkSmartPointer<vtkImageData> grid(const GridView& view) {
        auto data = vtkSmartPointer<vtkImageData>::New();
        const bool flat = view.dim == 2;
        data->SetDimensions(view.cells[0] + 1, view.cells[1] + 1, flat ? 1 : view.cells[2] + 1);
        data->SetOrigin(view.origin[0], view.origin[1], flat ? 0 : view.origin[2]);
        data->SetSpacing(view.spacing[0], view.spacing[1], flat ? view.spacing[0] : view.spacing[2]);
        return data;
    }
    static void draw_points(vtkPolyData& data) {
        vtkNew<vtkCellArray> vertices;
        for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) vertices->InsertNextCell(1, &i);
        data.SetVerts(vertices);
    }
    static void join(vtkPolyData& data, const SheetView& sheet) {
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
    template <class Writer>
    std::string bytes_of(vtkDataObject* data, real t) const {
        vtkNew<vtkDoubleArray> time;
        time->SetName("TimeValue");
        time->InsertNextValue(t);
        data->GetFieldData()->AddArray(time);
        vtkNew<Writer> writer;
        writer->SetInputData(data);
        writer->SetDataModeToAppended();
        writer->EncodeAppendedDataOff();
        if (options_.compression == output::Compression::none) writer->SetCompressorTypeToNone();
        if (options_.compression == output::Compression::lz4) writer->SetCompressorTypeToLZ4();
        if (options_.compression == output::Compression::zlib) writer->SetCompressorTypeToZLib(), writer->SetCompressionLevel(1);
        writer->WriteToOutputStringOn();
        return writer->Write() ? writer->GetOutputString() : std::string();
    }

    output::FrameOptions options_;
};

}  // namespace weir::test
