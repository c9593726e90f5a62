// weir run SCENE --explain: what the scene called for, what was built for it, what it costs, and what was left out.
#pragma once
#include "sim/simulation.hpp"

#include <string>

namespace weir::app {

/// Takes a few steps to measure with; nothing is written. Throws NumericalFailure if they fail.
std::string explain(Simulation& simulation);

}  // namespace weir::app
