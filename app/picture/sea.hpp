// Pictures of solvers whose state is a surface.
#pragma once
#include "app/picture/canvas.hpp"
#include "app/picture/view.hpp"

namespace weir::picture {

/// Whether the frame has the points of a surface.
bool has_sea(const output::FrameData& frame);
/// In 3D, from an eye over the water.
Canvas draw_sea(const View& view);

}  // namespace weir::picture
