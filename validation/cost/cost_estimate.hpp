// What a scene will cost, before it runs and without building it: memory from small copies of it (sim/memory_estimate.hpp), milliseconds
// from rates that coarser copies show on this machine now, a number of steps from the lengths that their steps had. Not covered: what comes
// later in a run.
#pragma once
#include "sim/memory_estimate.hpp"
#include "sim/registry.hpp"

#include <string>
#include <vector>

namespace weir::validation {

/// One copy of a scene in its first steps.
struct Rates {
    std::string cells{};
    double count = 0;            // cells, or particles
    double ms = 0;               // a step: the median
    std::vector<Pass> passes{};  // seconds: of that median, by their shares
    double dt = 0;               // [s] the mean
    double least_dt = 0, most_dt = 0;
    double iterations = 0;  // of a step's solve: the mean
    double viscous_iterations = 0;
    double most_cfl = 0;  // cells that anything crosses in a step; 0 where unknown
};

struct CostEstimate {
    std::string solver;
    int dim = 2;
    std::string cells{};
    double count = 0;
    bool particles = false;  // count is of particles
    sim::MemoryEstimate held{};
    sim::OutputEstimate output{};
    double ms = 0;                             // a step
    double dt = 0, least_dt = 0, most_dt = 0;  // a step: mean, shortest and longest of the small runs, on this scene's cells
    std::vector<Pass> passes{};                // seconds a step
    double iterations = 0, viscous_iterations = 0, most_cfl = 0;  // of the larger copy
    std::vector<Rates> measured{};                                // at which sizes
};

/// The first steps of a scene, timed.
Rates measure_rates(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double enough_seconds);
/// Two coarser copies of the scene, or the scene itself where it has none, and the powers of the size that they show.
CostEstimate estimate_cost(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds = sim::registry());
std::string cost_estimate_text(const CostEstimate& f, const scene::Scene& scene);

}  // namespace weir::validation
