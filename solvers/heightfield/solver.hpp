// The solver "heightfield": water as one depth a column of the plane.
#pragma once
#include "scene/solver_kind.hpp"

namespace weir::heightfield {

scene::SolverKind kind();

}  // namespace weir::heightfield
