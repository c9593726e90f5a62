// The effect "hand" as scenes say it (core/hand.hpp).
#pragma once
#include "core/hand.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::geometry {

scene::Variant hand_schema();
/// The scene's; nullptr where it names none. Refuses keyframes that lie behind one another in time, say too little, or are of a kind that
/// the solver does not have in this scene.
std::shared_ptr<Hand> make_hand(const scene::Scene& scene, std::initializer_list<HandKind> kinds);
/// The kinds of a hand on a fluid that moves.
inline constexpr std::initializer_list<HandKind> moving_kinds{HandKind::push, HandKind::pull, HandKind::pour, HandKind::drain};
inline constexpr std::initializer_list<HandKind> warming_kinds{HandKind::push, HandKind::pull, HandKind::pour, HandKind::drain,
                                                               HandKind::heat};
/// Of one that may heat, and that may take hold of bodies.
std::initializer_list<HandKind> kinds_of_hand(bool heats, bool holds);
/// A keyframe as the scene would say it.
scene::Table to_table(const HandKey& key, int dim);
/// hand_impulse_x .. [kg m/s], hand_mass [kg], and hand_heat [J] where it can heat, per metre of depth in 2D.
void sum_up(const Hand& hand, int dim, std::vector<Integral>& list);

}  // namespace weir::geometry
