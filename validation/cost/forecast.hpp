// What a scene will cost, before it runs: memory as it is built, milliseconds from rates that coarser copies of the scene show on this
// machine now. Of the scene itself one step is taken, to count what it allocates; it is not timed. Blind to what comes later in a run: it
// speaks of the scene as it begins.
#pragma once
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
};

struct PlannedField {
    std::string name, unit, where;
    std::size_t bytes = 0;
};

struct Forecast {
    std::string solver;
    int dim = 2;
    std::string cells{};
    double count = 0;
    bool particles = false;  // count is of particles
    std::vector<PlannedField> fields{};
    std::vector<EffectPlan> effects{};
    std::size_t bytes = 0;          // that the solver holds as it starts: exactly
    std::size_t bytes_moving = 0;   // and after its first step, in which lists and solves take what they need: exactly
    double ms = 0, dt = 0;          // a step
    std::vector<Pass> passes{};     // seconds a step
    std::vector<Rates> measured{};  // at which sizes
};

/// The first steps of a scene, timed.
Rates measure_rates(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double enough_seconds);
/// Two coarser copies of the scene, or the scene itself where it has none, and the powers of the size that they show.
Forecast forecast(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds = sim::registry());
std::string forecast_text(const Forecast& f, const scene::Scene& scene);

}  // namespace weir::validation
