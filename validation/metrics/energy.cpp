// Kinetic energy of the whole flow, and the rate at which it is lost; energy that water has won out of nothing.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/samples.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// -dE/dt at the middle of each step: viscosity's work and the scheme's together.
Curve dissipation(const Curve& energy) {
    Curve rate{.label = "weir", .x = {}, .y = {}};
    for (std::size_t i = 0; i + 1 < energy.size(); ++i) {
        rate.x.push_back((energy.x[i] + energy.x[i + 1]) / 2);
        rate.y.push_back(-(energy.y[i + 1] - energy.y[i]) / (energy.x[i + 1] - energy.x[i]));
    }
    return rate;
}

std::size_t peak(const Curve& c) {
    if (c.y.empty()) throw BadInput("no step was taken: there is no dissipation");
    return static_cast<std::size_t>(std::max_element(c.y.begin(), c.y.end()) - c.y.begin());
}

real observe_energy(const FieldSet& fields, const scene::Scene&, real) { return mean_kinetic_energy(fields); }

/// What does work that no integral counts: of gravity the potential energy tells.
void refuse_uncounted_work(const scene::Scene& scene) {
    const auto refuse = [](const std::string& what) {
        throw BadInput("energy_gain covers only the work of gravity; " + what + " do work that no integral records");
    };
    if (scene.has("bodies") && !scene.root().tables("bodies").empty())
        throw BadInput("energy_gain covers only the energy of the fluid; use budget.energy_gain for fluid and bodies");
    if (scene.has("emitters") && !scene.root().tables("emitters").empty()) refuse("emitters");
    if (scene.has("solids"))
        for (const scene::Table& solid : scene.root().tables("solids"))
            if (solid.has("motion")) refuse("moving solids");
    for (const char* side : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}) {
        const std::string path = std::string("sides.") + side;
        const std::string kind = scene.root().text_or(path + ".kind", "wall");
        if (scene.has(path + ".velocity") || (kind != "wall" && kind != "periodic")) refuse("sides that move or are open");
    }
}

/// The least potential energy that the fluid's mass could have in the domain, as if it all lay in the lowest corner.
real lowest_energy(const RunRecord& run) {
    const auto* gravity = run.scene->effect("gravity");
    if (!gravity) return 0;
    const GridView& grid = run.fields.grid;
    const auto g = gravity->numbers("g");
    real lowest = 0;
    for (std::size_t d = 0; d < g.size(); ++d) lowest += std::min(0.0, -g[d] * grid.spacing[d] * grid.cells[d]);
    const real mass =
        run.has_integral("mass") ? run.series("mass").y.front() : run.scene->number("fluid.density") * run.series("volume").y.front();
    return mass * lowest;
}

/// Kinetic, potential and, where water can be compressed, elastic energy over what the first two were first.
Curve total_energy(const RunRecord& run) {
    refuse_uncounted_work(*run.scene);
    Curve total = run.series("kinetic_energy");
    const Curve potential = run.series("potential_energy");
    const real first = total.y.front() + potential.y.front() - lowest_energy(run);
    const auto elastic = run.has_integral("elastic_energy") ? run.series("elastic_energy").y : std::vector<real>(total.size());
    for (std::size_t i = 0; i < total.size(); ++i) total.y[i] = (total.y[i] + potential.y[i] + elastic[i]) / first;
    return total;
}

/// Energy that is won after it was lost counts: dissipation does not pay for it.
real energy_gain(const RunRecord& run, const Reference&) {
    real least = infinity, gain = 0;
    for (const real energy : total_energy(run).y) {
        if (std::isnan(energy)) return energy;
        least = std::min(least, energy);
        gain = std::max(gain, energy - least);
    }
    return gain;
}

/// Compression at the start is not counted here: what it gives back is a rise too.
real energy_above_start(const RunRecord& run, const Reference&) {
    refuse_uncounted_work(*run.scene);
    const Curve kinetic = run.series("kinetic_energy"), potential = run.series("potential_energy");
    const real first = kinetic.y.front() + potential.y.front();
    real most = 0;
    for (std::size_t i = 0; i < kinetic.size(); ++i) {
        const real rise = kinetic.y[i] + potential.y[i] - first;
        if (std::isnan(rise)) return rise;
        most = std::max(most, rise);
    }
    return most / (first - lowest_energy(run));
}

}  // namespace

std::vector<Metric> energy_metrics() {
    return {
        {.name = "energy_gain",
         .unit = "",
         .doc = "Largest rise of kinetic, potential and elastic energy above the least they were before, over what the first two were "
                "first (potential: above "
                "the lowest corner of the domain).",
         .measure = energy_gain},
        {.name = "energy_above_start",
         .unit = "",
         .doc = "Largest rise of kinetic and potential energy above their first sum, over that sum.",
         .measure = energy_above_start},
        {.name = "flow.energy",
         .unit = "m^2/s^2",
         .doc = "Mean over the domain of |u|^2 / 2.",
         .quantity = Quantity::value,
         .measure = [](const RunRecord& run, const Reference&) { return run.series("flow.energy").y.back(); },
         .observe = observe_energy},
        {.name = "dissipation.peak_error",
         .unit = "",
         .doc = "Relative error of the largest rate at which kinetic energy is lost.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve rate = dissipation(run.series("dissipation.peak_error"));
                 return std::abs(rate.y[peak(rate)] / ref.number("peak_dissipation") - 1);
             },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Rate of energy loss",
                              .x = {"t [s]"},
                              .y = {"-dE/dt [m^2/s^3]"},
                              .curves = {ref.curve("dissipation"), dissipation(run.series("dissipation.peak_error"))}};
             },
         .observe = observe_energy},
        {.name = "dissipation.peak_time_error",
         .unit = "s",
         .doc = "Difference in time of the largest rate at which kinetic energy is lost.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve rate = dissipation(run.series("dissipation.peak_time_error"));
                 return std::abs(rate.x[peak(rate)] - ref.number("peak_time"));
             },
         .observe = observe_energy},
    };
}

}  // namespace weir::validation
