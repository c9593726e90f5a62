#include "app/picture/draw.hpp"

#include "app/picture/sea.hpp"
#include "app/picture/view.hpp"
#include "core/error.hpp"

namespace weir::picture {

Canvas draw(const scene::Scene& scene, output::FrameData frame, const Wishes& wishes) {
    particles_as_markers(frame, scene);
    if (wishes.field.empty() || wishes.field == "water") level_set_as_markers(frame);
    if (wishes.grid && scene.dim() != 2) throw BadInput("the grid is drawn in pictures of 2D runs");
    const std::string field = wishes.field.empty() ? best_field(frame) : wishes.field;
    const bool columns = is_of_columns(frame);
    if (field == "water" && !columns && !frame.particles.count("markers") && !has_sea(frame))
        throw BadInput("this run has no markers, and no surface, to draw as water");
    const View view{scene, frame, field, wishes.size, wishes.range, wishes.grid};
    return columns ? draw_columns(view) : scene.dim() == 2 ? draw_2d(view) : draw_3d(view);
}

}  // namespace weir::picture
