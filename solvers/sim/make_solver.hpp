// The solver of a scene, built with as many threads as the scene's cells have enough work for.
#pragma once
#include "core/solver.hpp"
#include "parallel/partition.hpp"
#include "scene/scene.hpp"
#include "scene/solver_kind.hpp"

#include <memory>

namespace weir::sim {

std::unique_ptr<Solver> make_solver(const scene::Scene& scene, const scene::SolverKind& kind, const Partition& cut);
/// Number of threads that the cells of a scene have enough work for.
int threads_for(const scene::Scene& scene);

}  // namespace weir::sim
