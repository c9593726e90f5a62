#include "sim/frame_options.hpp"

#include "sim/solid_cells.hpp"
#include "surfaces/reconstruction.hpp"

#include <memory>

namespace weir::sim {

output::FrameOptions frame_options(const scene::Scene& scene) {
    output::FrameOptions options;
    options.format = scene.text("output.format");
    options.fields = scene.root().texts("output.fields");
    options.faces = scene.flag("output.faces");
    options.single_precision = scene.text("output.precision") == "single";
    const std::string& compression = scene.text("output.compression");
    options.compression = compression == "none"  ? output::Compression::none
                          : compression == "lz4" ? output::Compression::lz4
                                                 : output::Compression::zlib;
    options.solid = solid_cells(scene);
    if (const std::shared_ptr<surfaces::Reconstruction> maker = surfaces::reconstruction_of(scene))
        options.surface = [maker](const FieldSet& fields, real t) -> const SurfaceMesh& { return maker->make_part(fields, t); };
    return options;
}

const std::string& frames_unavailable(const scene::Scene& scene) { return output::frame_format(scene.text("output.format")).unavailable; }

}  // namespace weir::sim
