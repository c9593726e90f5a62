// Solvers that measure one part of a method by itself, as scenes know them.
#pragma once
#include "scene/solver_kind.hpp"

namespace weir::studies {

scene::SolverKind transport_kind();       // "transport": advection through a prescribed flow
scene::SolverKind poisson_kind();         // "poisson": one pressure problem
scene::SolverKind phase_diagram_kind();   // "phase_diagram": what a substance is, by temperature and pressure
scene::SolverKind reconstruction_kind();  // "reconstruction": the surface around particles
scene::SolverKind closed_vessel_kind();   // "closed_vessel": water and its vapour come to their balance

}  // namespace weir::studies
