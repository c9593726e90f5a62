// What makes every rank of a run hold whole fields.
#pragma once
#include "scene/scene.hpp"

namespace weir::scene {

/// Whether all ranks are to look at all of a field: how much it has changed everywhere since the last step. Probes ask those who own their
/// places.
inline bool looks_at_whole_fields(const Scene& scene) { return scene.root().number_or("time.stop_when_steady", 0) > 0; }

}  // namespace weir::scene
