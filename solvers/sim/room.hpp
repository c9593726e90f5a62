// Whether solids that move leave room for the liquid of a closed domain: more liquid than room is refused before the run, as inflow without
// outflow is. What solids shut in a part of the domain shows in the run.
#pragma once
#include "scene/scene.hpp"

namespace weir::sim {

/// Throws BadScene where the liquid of a scene has less room at some time of the run than its own volume.
void require_room(const scene::Scene& scene);

}  // namespace weir::sim
