// The solvers of this folder as scenes know them.
#pragma once
#include "scene/solver_kind.hpp"

namespace weir::mac {

scene::SolverKind smoke_kind();      // "mac"
scene::SolverKind water_kind();      // "mac_water"
scene::SolverKind transport_kind();  // "transport"
scene::SolverKind poisson_kind();    // "poisson"

}  // namespace weir::mac
