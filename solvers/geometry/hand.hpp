// The effect "hand" as scenes say it (core/hand.hpp).
#pragma once
#include "core/hand.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::geometry {

scene::Variant hand_schema();
/// The scene's; nullptr where it names none. Refuses keyframes that lie behind one another in time, or say too little.
std::shared_ptr<Hand> make_hand(const scene::Scene& scene);
/// A keyframe as the scene would say it.
scene::Table to_table(const HandKey& key, int dim);
/// hand_impulse_x .. [kg m/s] and hand_mass [kg], per metre of depth in 2D.
void sum_up(const Hand& hand, int dim, std::vector<Integral>& list);

}  // namespace weir::geometry
