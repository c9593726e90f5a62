// weir run SCENE --explain: what the scene called for, what was built for it, what it costs, and what was left out.
#pragma once
#include "sim/simulation.hpp"

#include <string>

namespace weir::app {

/// Takes a few steps to measure with; nothing is written. Throws NumericalFailure if they fail.
std::string explain(Simulation& simulation);
/// How the domain is partitioned among the present ranks; empty in one process.
std::string explain_ranks(const Simulation& simulation);
/// Estimated memory and messages of a run on so many ranks.
std::string explain_planned_ranks(const scene::Scene& scene, int ranks);

}  // namespace weir::app
