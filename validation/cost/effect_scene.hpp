// Small scenes made from what a solver registers, one for each of its effects: what the table of the effects' cost and the audit of the
// effects run. A solver or an effect that is registered has its scenes.
#pragma once
#include "scene/solver_kind.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// A strength at which an effect is built like any other and does next to nothing.
inline constexpr real negligible = 1e-12;

/// A unit box of `cells` along each axis with what the solver's plain scene says (PlainStep::scene), and with what the named effects need
/// beside them (Variant::along_with), whether or not they are named themselves.
scene::Scene plain_scene(const scene::SolverKind& kind, int dim, int cells, const std::vector<std::string>& prepared_for = {});
/// The same with these effects, each of this strength.
scene::Scene scene_with(const scene::SolverKind& kind, int dim, int cells, const std::vector<std::string>& effects, real strength);

}  // namespace weir::validation
