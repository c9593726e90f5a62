#include "app/picture/draw.hpp"

#include "app/picture/quality.hpp"
#include "app/picture/sea.hpp"
#include "app/picture/view.hpp"
#include "core/error.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace weir::picture {

namespace {

constexpr int usual_size = 900, usual_size_of_quality = 1280;

/// Refused where there is nothing that rays pass through.
Canvas draw_with_rays(const View& view, bool columns) {
    if (columns || view.scene.dim() != 3) throw BadInput("--quality draws liquids and smoke in 3D");
    if (view.field == "water" && view.frame.particles.count("markers") == 0)
        throw BadInput("--quality draws water from its level set or its particles; this run has only surface heights");
    return draw_quality(view);
}

}  // namespace

Range range_of(const std::string& text) {
    const auto refuse = [&](const std::string& why) { throw BadInput("--range " + text + ": " + why + "; HIGH or LOW,HIGH is allowed"); };
    std::array<double, 2> ends{};
    std::size_t count = 0;
    const char *at = text.data(), *behind = at + text.size();
    for (; count < ends.size(); ++count) {
        const auto [next, error] = std::from_chars(at, behind, ends[count]);
        if (error != std::errc() || !std::isfinite(ends[count])) refuse("\"" + std::string(at, behind) + "\" is not a number");
        at = next;
        if (at == behind) break;
        if (*at++ != ',' || count == 1) refuse("\"" + std::string(at - 1, behind) + "\" has too many values");
    }
    if (count == 0 && ends[0] <= 0) refuse("a single value, that of the highest colour, must be greater than 0");
    if (count == 1 && ends[0] >= ends[1]) refuse("LOW must be less than HIGH");
    return count == 0 ? Range{{}, ends[0]} : Range{ends[0], ends[1]};
}

Canvas draw(const scene::Scene& scene, output::FrameData frame, const Options& options) {
    particles_as_markers(frame, scene);
    if (options.field.empty() || options.field == "water") level_set_as_markers(frame);
    if (options.grid && scene.dim() != 2) throw BadInput("--grid draws the grid of 2D runs only");
    const std::string field = options.field.empty() ? best_field(frame) : options.field;
    const bool columns = is_of_columns(frame);
    if (field == "water" && !columns && !frame.particles.count("markers") && !has_sea(frame))
        throw BadInput("this run has neither markers nor a surface to draw as water");
    const int size = options.size > 0 ? options.size : options.quality ? usual_size_of_quality : usual_size;
    const View view{scene, frame, field, size, options.range, options.surface, options.grid};
    if (!options.surface.empty() && (field != "water" || columns || (scene.dim() == 3 && !options.quality)))
        throw BadInput("--surface applies to liquids in 2D, and in 3D with --quality");
    if (options.quality) return draw_with_rays(view, columns);
    return columns ? draw_columns(view) : scene.dim() == 2 ? draw_2d(view) : draw_3d(view);
}

Canvas draw_frame(const std::filesystem::path& folder, const scene::Scene& scene, std::size_t number, const Options& options) {
    return draw(scene, output::read_frame(folder, number, scene.dim()), options);
}

}  // namespace weir::picture
