#include "app/view/series.hpp"

#include "core/error.hpp"
#include "output/read_frame.hpp"
#include "output/series_file.hpp"
#include "output/vtk_read.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellDataToPointData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkProbeFilter.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

namespace weir::view {

namespace {

void add_arrays(const std::vector<output::ReadArray>& from, vtkDataSetAttributes* to) {
    for (const output::ReadArray& array : from) {
        vtkSmartPointer<vtkDataArray> copy;
        if (array.bytes)
            copy = vtkSmartPointer<vtkUnsignedCharArray>::New();
        else
            copy = vtkSmartPointer<vtkDoubleArray>::New();
        copy->SetName(array.name.c_str());
        copy->SetNumberOfComponents(static_cast<int>(array.components));
        copy->SetNumberOfTuples(static_cast<vtkIdType>(array.tuples()));
        for (std::size_t i = 0; i < array.values.size(); ++i)
            copy->SetComponent(static_cast<vtkIdType>(i / array.components), static_cast<int>(i % array.components), array.values[i]);
        to->AddArray(copy);
    }
}

vtkSmartPointer<vtkImageData> image_of(const output::ReadFile& file) {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(file.points[0], file.points[1], file.points[2]);
    image->SetOrigin(file.origin.data());
    image->SetSpacing(file.spacing.data());
    add_arrays(file.cell_data, image->GetCellData());
    add_arrays(file.point_data, image->GetPointData());
    return image;
}

vtkSmartPointer<vtkCellArray> cells_of(const output::ReadCells& cells) {
    vtkNew<vtkTypeInt64Array> offsets, corners;
    offsets->InsertNextValue(0);
    for (const std::int64_t end : cells.ends) offsets->InsertNextValue(end);
    for (const std::int64_t corner : cells.corners) corners->InsertNextValue(corner);
    auto list = vtkSmartPointer<vtkCellArray>::New();
    list->SetData(offsets, corners);
    return list;
}

vtkSmartPointer<vtkPolyData> points_of(const output::ReadFile& file) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (std::size_t i = 0; i + 2 < file.position.size(); i += 3) points->InsertNextPoint(&file.position[i]);
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetVerts(cells_of(file.vertices));
    data->SetLines(cells_of(file.lines));
    data->SetPolys(cells_of(file.polygons));
    add_arrays(file.point_data, data->GetPointData());
    return data;
}

/// Of this kind, as its name says.
output::ReadFile opened(const std::filesystem::path& file, bool image) {
    output::ReadFile read = output::read_vtk(file);
    if (read.image != image) throw BadInput(file.string() + ": this frame contains no " + (image ? "grid" : "points"));
    return read;
}

std::string array_of(const std::string& field) { return field == "speed" ? "velocity" : field; }

void add_names(vtkDataSetAttributes* data, std::vector<std::string>& names) {
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        if (!data->GetArray(i)) continue;
        const std::string array = data->GetArrayName(i), name = array == "velocity" ? "speed" : array;
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
}

/// A number a tuple: itself, or its length.
vtkSmartPointer<vtkFloatArray> numbers(vtkDataArray& array) {
    auto values = vtkSmartPointer<vtkFloatArray>::New();
    values->SetName("shown");
    values->SetNumberOfTuples(array.GetNumberOfTuples());
    for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i) {
        double sum = 0;
        for (int c = 0; c < array.GetNumberOfComponents(); ++c) sum += array.GetComponent(i, c) * array.GetComponent(i, c);
        values->SetValue(i, static_cast<float>(array.GetNumberOfComponents() == 1 ? array.GetComponent(i, 0) : std::sqrt(sum)));
    }
    return values;
}

/// The grid with its cells' values carried to their corners.
vtkSmartPointer<vtkDataSet> at_points(vtkImageData* grid, const std::string& array) {
    vtkNew<vtkImageData> only;
    only->CopyStructure(grid);
    only->GetCellData()->AddArray(grid->GetCellData()->GetArray(array.c_str()));
    vtkNew<vtkCellDataToPointData> corners;
    corners->SetInputData(only);
    corners->Update();
    return corners->GetOutput();
}

}  // namespace

Series::Series(std::filesystem::path folder) : folder_(std::move(folder)), times_(output::frame_times(folder_)) {}

Frame Series::read(std::size_t number) const {
    Frame frame;
    for (const auto& name : output::series_in(folder_, output::pvd_index())) {
        const auto entries = output::read_series(folder_ / name);
        if (number >= entries.size()) throw BadInput((folder_ / name).string() + " has only " + std::to_string(entries.size()) + " frames");
        const auto file = folder_ / entries[number].file;
        frame.time = entries[number].time;
        if (file.extension() == ".vtp") frame.particles[name.stem().string()] = points_of(opened(file, false));
        if (name.stem() == "grid") frame.grid = image_of(opened(file, true));
    }
    return frame;
}

std::vector<std::string> field_names(const Frame& frame) {
    std::vector<std::string> names;
    if (frame.grid) add_names(frame.grid->GetCellData(), names);
    for (const auto& [set, points] : frame.particles) add_names(points->GetPointData(), names);
    return names;
}

vtkSmartPointer<vtkFloatArray> numbers_of_cells(const Frame& frame, const std::string& field) {
    vtkDataArray* array = frame.grid ? frame.grid->GetCellData()->GetArray(array_of(field).c_str()) : nullptr;
    return array ? numbers(*array) : nullptr;
}

vtkSmartPointer<vtkDataSet> coloured(vtkDataSet* data, const Frame& frame, const std::string& field) {
    const std::string array = array_of(field);
    vtkSmartPointer<vtkDataSet> with = data;
    if (!data->GetPointData()->GetArray(array.c_str())) {
        if (!frame.grid || !frame.grid->GetCellData()->GetArray(array.c_str())) return nullptr;
        with = at_points(frame.grid, array);
        if (data != frame.grid.Get()) {
            vtkNew<vtkProbeFilter> probe;
            probe->SetInputData(data);
            probe->SetSourceData(with);
            probe->Update();
            with = probe->GetOutput();
        }
    }
    vtkSmartPointer<vtkDataSet> copy;
    copy.TakeReference(data->NewInstance());
    copy->CopyStructure(data);
    copy->GetPointData()->SetScalars(numbers(*with->GetPointData()->GetArray(array.c_str())));
    return copy;
}

}  // namespace weir::view
