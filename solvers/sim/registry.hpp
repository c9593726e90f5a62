// Registry of all solvers by name: one line each in registry.cpp. The reader, messages, describe, run and validate use it.
#pragma once
#include "scene/solver_kind.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::sim {

const std::vector<scene::SolverKind>& registry();
/// Their schemas, for the scene reader.
const std::vector<scene::SolverSchema>& schemas();
/// The solver of that name, which a checked scene always has; std::logic_error otherwise.
const scene::SolverKind& kind_named(std::string_view name, const std::vector<scene::SolverKind>& kinds = registry());

/// Rejects, by its key, what does not run on this number of ranks; see ParallelSupport::check.
void require_ranks(const scene::Scene& scene, int ranks, const std::vector<scene::SolverKind>& kinds = registry());

}  // namespace weir::sim
