// "output.surface", as solvers of liquids with a free surface offer it: what reads it is reconstruction/options.cpp.
#pragma once
#include "scene/schema.hpp"

namespace weir::scene {

/// The key "output" with this one in it, to be laid over the common one: for a solver of particles, and for one that has a level set (and
/// markers).
Key surface_key_of_particles();
Key surface_key_of_level_set(bool markers);

}  // namespace weir::scene
