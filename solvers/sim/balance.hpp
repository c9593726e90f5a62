// The balance of a run: the solver's integrals at its start and its end, and the net inflow. The change that the inflow does not explain is
// the run's error. Integrals are computed at the start, in every 16th step (not in parallel (MPI)), at frames, at the end.
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
    std::optional<real> inflow;       // net, from sources, sides and evaporation; no value: not recorded
    std::optional<real> unexplained;  // (end - start - inflow) / scale; for energy, the highest value replaces the end
    real scale = 0;                   // reference value of 100%
    std::optional<real> highest;      // maximum of all samples
    std::optional<real> furthest;     // largest unexplained part of any sample
};

/// Numbers that show the reliability of a run.
struct BalanceOfRun {
    real from = 0, to = 0;  // [s]
    std::vector<Balanced> quantities;
    std::vector<Integral> corrected;                 // corrections: particles moved to a wall, reseeded markers, ...
    std::vector<Integral> air;                       // at the end: pockets, volume and pressure of the largest; empty without enclosed air
    real divergence = not_applicable;                // maximum over the steps [1/s]
    real cell_change = not_applicable;               // largest relative volume error of a cell in one step
    std::vector<std::pair<std::string, real>> thin;  // solids thinner than two cells, and their thickness in cells
    std::vector<std::string> warnings;               // one for each error beyond 1%
};

/// Records a run's balance. All its functions are collective.
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

/// Kinetic, potential and elastic energy, including bodies, as far as a solver reports them; no value without kinetic energy.
std::optional<real> total_energy(const std::vector<Integral>& integrals);

/// Returns whether only gravity and friction do work on the fluid, so that the total energy cannot grow.
bool energy_cannot_grow(const scene::Scene& scene);

/// Returns whether there is no inflow or outflow: no emitters or sinks, no open sides, no brush, no rain.
bool is_closed(const scene::Scene& scene);

/// A part as a percentage with at least two significant digits and without exponent: "0.052%", "9.4%", "123%", "90000%".
std::string percent_text(real part);

/// Boxes, balls, capsules and cylinders among the solids that are thinner than two cells, by key, and their thickness in cells.
std::vector<std::pair<std::string, real>> thin_solids(const scene::Scene& scene, const GridView& grid);

}  // namespace weir::sim
