#include "app/picture/liquid.hpp"

#include "core/error.hpp"

namespace weir::picture {

namespace {

constexpr int usual_smoothing = 5;  // as output.surface has it where it says nothing

}  // namespace

FieldSet fields_of(const output::FrameData& frame, const scene::Scene& scene) {
    FieldSet set;
    const auto size = scene.root().numbers("grid.size"), origin = scene.root().numbers("grid.origin"),
               cells = scene.root().numbers("grid.cells");
    set.grid.dim = scene.dim();
    for (std::size_t a = 0; a < static_cast<std::size_t>(scene.dim()); ++a)
        set.grid.cells[a] = static_cast<int>(cells[a]), set.grid.origin[a] = origin[a], set.grid.spacing[a] = size[a] / cells[a];
    const auto add = [&](const std::string& name, Where where, const std::string& of, const output::Components& data) {
        FieldView view{name, "", where, of, {}};
        for (const auto& component : data) view.data.push_back(component);
        set.fields.push_back(std::move(view));
    };
    for (const auto& [name, data] : frame.cells)
        if (name == level_set_name || name == "velocity") add(name, Where::cell, "", data);
    for (const auto& [of, fields] : frame.particles)
        if (of == marker_set_name || of == particle_set_name)
            for (const auto& [name, data] : fields) add(name, Where::particle, frame.cells.empty() ? particle_set_name : of, data);
    return set;
}

surfaces::Options options_for(const View& view, const FieldSet& fields) {
    using surfaces::Method;
    const bool particles = fields.find(marker_set_name, "position") || fields.find(particle_set_name, "position");
    if (!view.surface.empty()) {
        const Method method = surfaces::method_named(view.surface);
        if (method == Method::level_set && !fields.find(level_set_name)) throw BadInput("--surface level_set: this run has no level set");
        if (method != Method::level_set && !particles) throw BadInput("--surface " + view.surface + ": this run has no particles");
        return {method, 1, method == Method::density ? usual_smoothing : 0};
    }
    if (const auto said = surfaces::options_of(view.scene)) return *said;
    return {particles ? Method::anisotropic : Method::level_set, 1, 0};
}

}  // namespace weir::picture
