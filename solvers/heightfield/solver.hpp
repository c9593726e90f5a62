// The solver "heightfield": water as one depth per column of the plane.
#pragma once
#include "scene/solver_kind.hpp"

namespace weir::heightfield {

scene::SolverKind kind();

}  // namespace weir::heightfield
