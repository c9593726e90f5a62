// Solvers that measure a single part of a method.
#pragma once
#include "scene/solver_kind.hpp"

namespace weir::studies {

scene::SolverKind transport_kind();       // "transport": advection through a prescribed flow
scene::SolverKind poisson_kind();         // "poisson": one pressure problem
scene::SolverKind phase_diagram_kind();   // "phase_diagram": the state of a substance by temperature and pressure
scene::SolverKind reconstruction_kind();  // "reconstruction": the surface around particles
scene::SolverKind closed_vessel_kind();   // "closed_vessel": equilibrium of water and its vapour

}  // namespace weir::studies
