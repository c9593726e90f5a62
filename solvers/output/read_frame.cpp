#include "output/read_frame.hpp"

#include "core/error.hpp"
#include "output/series_file.hpp"

#ifdef WEIR_HAS_VTK
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#endif

namespace weir::output {

std::vector<real> frame_times(const std::filesystem::path& folder) {
    std::vector<real> times;
    for (const auto& name : series_in(folder)) {
        times.clear();
        for (const auto& entry : read_series(folder / name)) times.push_back(entry.time);
    }
    if (times.empty()) throw BadInput(folder.string() + " holds no series of frames");
    return times;
}

FrameData frame_of(const FieldSet& fields, real t) {
    FrameData frame{.time = t, .grid = fields.grid, .cells = {}, .particles = {}};
    for (const FieldView& f : fields.fields) {
        if (f.where == Where::face) continue;  // frames hold them on request, as images of their own
        Components values;
        for (const auto& component : f.data) values.emplace_back(component.begin(), component.end());
        if (values.size() == 2) values.emplace_back(values[0].size(), 0.0);  // as files have it
        (f.where == Where::cell ? frame.cells : frame.particles[f.set])[f.name] = std::move(values);
    }
    return frame;
}

#ifdef WEIR_HAS_VTK

namespace {

Components components_of(vtkDataArray& array) {
    Components list(static_cast<std::size_t>(array.GetNumberOfComponents()));
    for (std::size_t c = 0; c < list.size(); ++c)
        for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i) list[c].push_back(array.GetComponent(i, static_cast<int>(c)));
    return list;
}

template <class Reader>
void open(Reader& reader, const std::filesystem::path& file) {
    if (!reader.CanReadFile(file.c_str())) throw BadInput(file.string() + ": cannot read this frame");
    reader.SetFileName(file.c_str());
    reader.Update();
}

void read_image(const std::filesystem::path& file, int dim, FrameData& frame) {
    vtkNew<vtkXMLImageDataReader> reader;
    open(*reader, file);
    vtkImageData* image = reader->GetOutput();
    frame.grid.dim = dim;
    for (int a = 0; a < dim; ++a) {
        const auto at = static_cast<std::size_t>(a);
        frame.grid.cells[at] = image->GetDimensions()[a] - 1;
        frame.grid.origin[at] = image->GetOrigin()[a];
        frame.grid.spacing[at] = image->GetSpacing()[a];
    }
    for (int i = 0; i < image->GetCellData()->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = image->GetCellData()->GetArray(i);
        if (array != image->GetCellGhostArray()) frame.cells[array->GetName()] = components_of(*array);
    }
}

void read_particles(const std::filesystem::path& file, std::map<std::string, Components>& fields) {
    vtkNew<vtkXMLPolyDataReader> reader;
    open(*reader, file);
    vtkPolyData* data = reader->GetOutput();
    fields["position"] = Components(3);
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
        for (std::size_t c = 0; c < 3; ++c) fields["position"][c].push_back(data->GetPoint(i)[c]);
    for (int i = 0; i < data->GetPointData()->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = data->GetPointData()->GetArray(i);
        fields[array->GetName()] = components_of(*array);
    }
}

}  // namespace

FrameData read_frame(const std::filesystem::path& folder, std::size_t frame, int dim) {
    FrameData data;
    for (const auto& name : series_in(folder)) {
        const auto entries = read_series(folder / name);
        if (frame >= entries.size()) throw BadInput((folder / name).string() + " has only " + std::to_string(entries.size()) + " frames");
        const auto file = folder / entries[frame].file;
        data.time = entries[frame].time;
        if (file.extension() == ".vtp") read_particles(file, data.particles[name.stem().string()]);
        if (name.stem() == "grid") read_image(file, dim, data);
    }
    return data;
}

#else

FrameData read_frame(const std::filesystem::path&, std::size_t, int) {
    throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and reads no frames");
}

#endif

}  // namespace weir::output
