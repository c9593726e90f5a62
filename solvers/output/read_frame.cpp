#include "output/read_frame.hpp"

#include "core/error.hpp"
#include "output/series_file.hpp"

#ifdef WEIR_HAS_VTK
#include "output/vtk_read.hpp"
#endif

namespace weir::output {

std::vector<real> frame_times(const std::filesystem::path& folder) {
    std::vector<real> times;
    for (const auto& name : series_in(folder, pvd_index())) {
        times.clear();
        for (const auto& entry : read_series(folder / name)) times.push_back(entry.time);
    }
    if (times.empty()) throw BadInput(folder.string() + " contains no series of VTK frames (.pvd), which output.format = \"vtk\" writes");
    return times;
}

FrameData frame_of(const FieldSet& fields, real t) {
    FrameData frame{.time = t, .grid = fields.grid, .cells = {}, .particles = {}};
    for (const FieldView& f : fields.fields) {
        if (f.where == Where::face) continue;  // frames contain them on request, as separate images
        Components values;
        for (const auto& component : f.data) values.emplace_back(component.begin(), component.end());
        if (values.size() == 2) values.emplace_back(values[0].size(), 0.0);  // as in files
        (f.where == Where::cell ? frame.cells : frame.particles[f.set])[f.name] = std::move(values);
    }
    return frame;
}

#ifdef WEIR_HAS_VTK

namespace {

constexpr const char* hidden_cells = "vtkGhostType";

Components components_of(const std::vector<real>& values, std::size_t components) {
    Components list(components);
    for (std::size_t c = 0; c < components; ++c)
        for (std::size_t i = c; i < values.size(); i += components) list[c].push_back(values[i]);
    return list;
}

void read_image(const std::filesystem::path& file, int dim, FrameData& frame) {
    const ReadFile image = read_vtk(file);
    frame.grid.dim = dim;
    for (std::size_t a = 0; a < 3; ++a) {
        const int cells = image.points[a] - 1;
        if ((cells < 1) == (static_cast<int>(a) < dim) || !image.image)
            throw BadInput(file.string() + ": this frame contains no grid of " + std::to_string(dim) + " dimensions, which the scene has");
        if (cells < 1) continue;
        frame.grid.cells[a] = cells, frame.grid.origin[a] = image.origin[a], frame.grid.spacing[a] = image.spacing[a];
    }
    for (const ReadArray& array : image.cell_data)
        if (array.name != hidden_cells) frame.cells[array.name] = components_of(array.values, array.components);
}

void read_particles(const std::filesystem::path& file, std::map<std::string, Components>& fields) {
    const ReadFile points = read_vtk(file);
    if (points.image) throw BadInput(file.string() + ": this frame contains no points");
    for (const ReadArray& array : points.point_data) fields[array.name] = components_of(array.values, array.components);
    fields["position"] = components_of(points.position, 3);
}

}  // namespace

FrameData read_frame(const std::filesystem::path& folder, std::size_t frame, int dim) {
    FrameData data;
    for (const auto& name : series_in(folder, pvd_index())) {
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
