// The effect "hand" (interactive forcing) in scenes (core/brush.hpp).
#pragma once
#include "core/brush.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::geometry {

scene::Variant brush_schema();
/// The scene's interactive forcing; nullptr where it has none. Rejects keyframes that are out of order in time, incomplete, or of a kind
/// that the solver does not support in this scene.
std::shared_ptr<BrushForcing> make_brush(const scene::Scene& scene, std::initializer_list<BrushKind> kinds);
/// The kinds for a moving fluid.
inline constexpr std::initializer_list<BrushKind> moving_kinds{BrushKind::push, BrushKind::pull, BrushKind::pour, BrushKind::drain};
inline constexpr std::initializer_list<BrushKind> warming_kinds{BrushKind::push, BrushKind::pull, BrushKind::pour, BrushKind::drain,
                                                                BrushKind::heat};
/// The kinds with optional heating and grabbing of bodies.
std::initializer_list<BrushKind> kinds_of_brush(bool heats, bool holds);
/// A keyframe as written in a scene.
scene::Table to_table(const BrushKeyframe& key, int dim);
/// hand_impulse_x .. [kg m/s], hand_mass [kg], and hand_heat [J] where it can heat, per metre of depth in 2D.
void sum_up(const BrushForcing& forcing, int dim, std::vector<Integral>& list);

}  // namespace weir::geometry
