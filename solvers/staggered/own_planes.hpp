// Over ranks: may each hold its own planes of a scene on a staggered grid alone, and how?
#pragma once
#include "core/halo.hpp"
#include "core/held_planes.hpp"
#include "scene/scene.hpp"

#include <string>

namespace weir::staggered {

/// Not where somebody looks at whole fields on all ranks, nor where each solves for the pressure itself.
bool holds_own_planes(const scene::Scene& scene, const Cut& cut);
/// Where nobody but the scene asks for more.
bool could_hold_own_planes(const scene::Scene& scene, const Cut& cut);
/// What of the pressure every rank does alone: the small levels where "multigrid" shares it, the matrix where PETSc does, else all.
std::string pressure_by_all(const scene::Scene& scene, const Cut& cut);
/// As a solver of the scene holds them, where alone with `deep` planes beyond its cuts.
template <int D>
HeldPlanes held_planes(const scene::Scene& scene, int deep, int reach = 1);

}  // namespace weir::staggered
