// The balance of a run: what the solver's integrals were at its start and are at its end, and what of the change came in or went out. What
// neither accounts for is the run's error. Integrals are taken at the start, in every 16th step, at frames and at the end.
#pragma once
#include "core/solver.hpp"
#include "sim/simulation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::sim {

/// A conserved quantity over a run.
struct Balanced {
    std::string name, unit;
    real start = 0, end = 0;
    std::optional<real> inflow;       // net, what sources, sides and evaporation account for; not known: nothing counts it
    std::optional<real> unexplained;  // part of `scale` that the end has beyond the start and the inflow
    real scale = 0;                   // what 100% are
    std::optional<real> highest;      // of all that were taken
    std::optional<real> furthest;     // unexplained part of any that was taken
};

/// Numbers of a run that tell how far to trust it.
struct BalanceOfRun {
    real from = 0, to = 0;  // [s]
    std::vector<Balanced> quantities;
    std::vector<Integral> corrected;                 // what was put right: particles moved to a wall, markers sown anew, ...
    real divergence = not_applicable;                // largest of any step [1/s]
    real cell_change = not_applicable;               // largest part of a cell's volume that a step has made or lost
    std::vector<std::pair<std::string, real>> thin;  // solids thinner than two cells, and how many cells they are thick
    std::vector<std::string> warnings;               // what is beyond 1%
};

/// Takes a run's balance. All ranks call its functions together.
class Balance {
public:
    explicit Balance(const Simulation& simulation);
    void on_step(const Simulation& simulation, const StepReport& report);
    void on_frame(const Simulation& simulation);
    BalanceOfRun of_run(const Simulation& simulation) const;

private:
    static constexpr std::int64_t steps_between = 16;  // what is thrown stays fast for longer; integrals cost less than a tenth of a step

    real from_;
    std::int64_t steps_ = 0;
    std::vector<Integral> start_;
    real highest_energy_ = -infinity, furthest_drift_ = 0;
    real divergence_ = not_applicable, cell_change_ = not_applicable;
};

/// Kinetic, potential and elastic energy, that of bodies included, as far as a solver states them; none where it states no kinetic one.
std::optional<real> total_energy(const std::vector<Integral>& integrals);

/// Whether all work on the fluid is gravity's or friction's, so that the total energy cannot grow; false where something else may do work.
bool energy_cannot_grow(const scene::Scene& scene);

/// Whether nothing comes in or goes out: no emitters or sinks, no open sides, no brush, no rain.
bool is_closed(const scene::Scene& scene);

/// Boxes, balls, capsules and cylinders among the solids that are thinner than two cells, by key, and their thickness in cells.
std::vector<std::pair<std::string, real>> thin_solids(const scene::Scene& scene, const GridView& grid);

}  // namespace weir::sim
