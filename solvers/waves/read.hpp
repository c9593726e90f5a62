// Reads waves from a scene, and rejects scenes that procedural waves cannot represent.
#pragma once
#include "scene/scene.hpp"
#include "waves/dispersion.hpp"
#include "waves/sheet.hpp"

namespace weir::waves {

/// The scene's gravity and surface tension.
Restoring restoring(const scene::Scene& scene);
/// The height of the surface at rest [m].
real mean_level(const scene::Scene& scene, const Box& box);

}  // namespace weir::waves
