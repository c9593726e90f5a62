// Checks that moving solids leave enough volume for the liquid of a closed domain. Too little volume is rejected before the run, as inflow
// without outflow is. Liquid enclosed by solids in a part of the domain is detected only during the run.
#pragma once
#include "scene/scene.hpp"

namespace weir::sim {

/// Throws BadScene where the free volume at some time of the run is smaller than the volume of the liquid.
void require_room(const scene::Scene& scene);

}  // namespace weir::sim
