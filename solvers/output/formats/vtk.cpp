// Frames as VTK's XML files: one image (.vti) of the grid, one (.vtp) of each particle set and of the liquid's surface, and a .pvd series
// for each, as read by ParaView.
#include "output/frame_arrays.hpp"
#include "output/frame_format.hpp"
#include "output/series_file.hpp"
#include "output/vtk_frame.hpp"

namespace weir::output {

namespace {

void write_vtk(const FieldSet& fields, real t, const FrameOptions& options, const FrameFile& file) {
    const auto put = [&](const std::string& series, const char* extension, const VtkFile& content) {
        write(file(series, extension), content, options.compression);
    };
    if (has_grid_fields(fields, options)) put("grid", ".vti", image_of(fields, t, options));
    if (options.faces && has_grid_fields(fields, options, true))
        for (int axis = 0; axis < fields.grid.dim; ++axis)
            put(std::string("faces_") + "xyz"[axis], ".vti", face_image_of(fields, axis, t, options));
    for (const auto& set : particle_sets(fields)) put(set, ".vtp", particles_of(fields, set, t, options));
    if (options.surface) put("liquid_surface", ".vtp", surface_of(options.surface(fields, t), t, options));
}

std::string viewers(const std::string& folder) {
    return "weir view " + folder + " (a window), weir picture " + folder + " (a PNG), or open the .pvd in ParaView";
}

}  // namespace

FrameFormat vtk_format() {
#ifdef WEIR_HAS_VTK
    const char* unavailable = "";
#else
    const char* unavailable = "this weir was built without VTK (WEIR_VTK=OFF)";
#endif
    return {.name = "vtk", .write = write_vtk, .index = pvd_index(), .viewers = viewers, .unavailable = unavailable};
}

}  // namespace weir::output
