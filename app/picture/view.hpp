// What a picture is made of: one frame and the scene that it belongs to.
#pragma once
#include "app/picture/canvas.hpp"
#include "app/picture/draw.hpp"
#include "output/read_frame.hpp"
#include "rigid/bodies.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::picture {

struct View {
    const scene::Scene& scene;
    const output::FrameData& frame;
    std::string field;      // smoke, speed, vorticity, temperature, pressure, ...; or "water": the markers
    int size = 900;         // pixels of the longer side
    Range range{};          // of colours
    std::string surface{};  // how the liquid's surface is made; empty: as the scene says
    bool grid = false;      // 2D: lines between the cells that hold liquid, tall ones as they are
};

/// What a frame says of its bodies, as rigid::ShownSolids asks for it.
inline auto bodies_of(const output::FrameData& frame) {
    return [&frame](const char* field, std::size_t component, std::size_t body) {
        return frame.particles.at(rigid::body_set_name).at(field).at(component).at(body);
    };
}
/// Lets a run without a grid be drawn: its particles become markers, on a grid of the scene's domain with 2^D of them to a cell.
void particles_as_markers(output::FrameData& frame, const scene::Scene& scene);
/// Lets a run of liquid that has a level set and no markers be drawn as water: 2^D markers to a cell where the level set is negative.
void level_set_as_markers(output::FrameData& frame);
/// The name in such a set of markers that says where they come from.
inline constexpr const char* from_level_set = "from level set";
/// The field worth showing: water where there are markers, else smoke, temperature, speed.
std::string best_field(const output::FrameData& frame);
/// A cell field by name; "speed" and (in 2D) "vorticity" are made from the velocity. Throws BadInput naming what there is.
std::vector<real> scalar_field(const output::FrameData& frame, const std::string& name);
/// Speed of each marker: its own velocity, or the grid's at its place.
std::vector<real> marker_speeds(const output::FrameData& frame);
/// A number that each marker carries, by the name of its field; null where there is none.
const std::vector<real>* marker_field(const output::FrameData& frame, const std::string& name);

/// Whether the frame holds columns of water; they are drawn by what follows, whatever the dimension.
bool is_of_columns(const output::FrameData& frame);
Canvas draw_columns(const View& view);
Canvas draw_2d(const View& view);
Canvas draw_3d(const View& view);

}  // namespace weir::picture
