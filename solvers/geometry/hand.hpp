// The effect "hand" (interactive forcing) in scenes (core/hand.hpp).
#pragma once
#include "core/hand.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::geometry {

scene::Variant hand_schema();
/// The scene's interactive forcing; nullptr where it has none. Rejects keyframes that are out of order in time, incomplete, or of a kind
/// that the solver does not support in this scene.
std::shared_ptr<Hand> make_hand(const scene::Scene& scene, std::initializer_list<HandKind> kinds);
/// The kinds for a moving fluid.
inline constexpr std::initializer_list<HandKind> moving_kinds{HandKind::push, HandKind::pull, HandKind::pour, HandKind::drain};
inline constexpr std::initializer_list<HandKind> warming_kinds{HandKind::push, HandKind::pull, HandKind::pour, HandKind::drain,
                                                               HandKind::heat};
/// The kinds with optional heating and grabbing of bodies.
std::initializer_list<HandKind> kinds_of_hand(bool heats, bool holds);
/// A keyframe as written in a scene.
scene::Table to_table(const HandKey& key, int dim);
/// hand_impulse_x .. [kg m/s], hand_mass [kg], and hand_heat [J] where it can heat, per metre of depth in 2D.
void sum_up(const Hand& hand, int dim, std::vector<Integral>& list);

}  // namespace weir::geometry
