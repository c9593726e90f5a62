// Scenes that are small enough to be run thousands of times.
#pragma once
#include "core/error.hpp"
#include "sim/memory_estimate.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"

namespace weir::fuzz {

/// At most so many cells, and as many bytes as a fuzzer may have. Throws BadInput otherwise, as `weir run` does on a small machine.
inline void require_small(const scene::Scene& scene) {
    real cells = 1;
    for (const real n : scene.root().numbers("grid.cells")) cells *= n;
    if (cells > 600) throw BadInput("too many cells for a fuzzer");
    sim::require_memory(scene, sim::registry(), sim::Use::solver, 64e6);
}

}  // namespace weir::fuzz
