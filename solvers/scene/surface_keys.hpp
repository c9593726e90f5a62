// "output.surface", for solvers of liquids with a free surface; read by surfaces/options.cpp.
#pragma once
#include "scene/schema.hpp"

namespace weir::scene {

/// The key "output" with this one, to be overlaid on the common one: for particle solvers, and for solvers with a level set (and markers).
/// markers).
Key surface_key_of_particles();
Key surface_key_of_level_set(bool markers);

}  // namespace weir::scene
