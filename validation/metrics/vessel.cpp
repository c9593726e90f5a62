// Water and its vapour in a closed vessel, at the end of each step of its surroundings' temperature.
#include "validation/metrics/lists.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Rows of the table for the run's mass, each with what the run had at the last moment at which its surroundings had that temperature.
struct VesselRest {
    real T, p, vapour, u, pressure_in_table, vapour_in_table;
    bool dry;
    std::size_t moment;
};

std::vector<VesselRest> rests(const RunRecord& run, const Reference& ref) {
    const Curve pressure = run.series("pressure"), vapour = run.series("vapour_mass");
    std::vector<VesselRest> list;
    for (std::size_t i = 0; i < ref.curve("pressure").size(); ++i) {
        VesselRest rest{};
        rest.T = ref.curve("pressure").x[i], rest.pressure_in_table = ref.curve("pressure").y[i];
        rest.vapour_in_table = ref.curve("vapour").y[i], rest.u = ref.curve("energy").y[i], rest.dry = ref.curve("dry").y[i] > 0;
        const real ends = ref.curve("until").y[i];
        rest.moment = 0;
        while (rest.moment + 1 < pressure.size() && pressure.x[rest.moment + 1] <= ends * (1 + 1e-9)) ++rest.moment;
        rest.p = pressure.y[rest.moment], rest.vapour = vapour.y[rest.moment];
        list.push_back(rest);
    }
    std::sort(list.begin(), list.end(), [](const VesselRest& a, const VesselRest& b) { return a.moment < b.moment; });
    return list;
}

template <class F>
Metric worst_of(const char* name, const char* doc, F&& error) {
    return {.name = name, .unit = "", .doc = doc, .measure = [error](const RunRecord& run, const Reference& ref) {
                real worst = 0;
                for (const VesselRest& rest : rests(run, ref))
                    if (const real e = std::abs(error(rest)); !(e <= worst)) worst = e;
                return worst;
            }};
}

/// Heat from one rest to the next against m du, over the larger of the energies' steps; of rows whose energy the table has.
real vessel_heat(const RunRecord& run, const Reference& ref) {
    const Curve added = run.series("heat_added");
    const real m = run.scene->number("vessel.mass");
    const auto list = rests(run, ref);
    real worst = 0;
    for (std::size_t i = 1; i < list.size(); ++i) {
        const real du = list[i].u - list[i - 1].u;
        if (std::isnan(du)) continue;
        const real error = std::abs((added.y[list[i].moment] - added.y[list[i - 1].moment]) / (m * du) - 1);
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

real misjudged(const RunRecord& run, const Reference& ref) {
    const Curve liquid = run.series("liquid_mass");
    real count = 0;
    for (const VesselRest& rest : rests(run, ref)) count += (liquid.y[rest.moment] == 0) != rest.dry;
    return count;
}

real vessel_balance(const RunRecord& run, const Reference&) {
    const Curve U = run.series("internal_energy"), added = run.series("heat_added");
    real worst = 0, most = 0;
    for (std::size_t i = 0; i < U.size(); ++i) {
        worst = std::max(worst, std::abs(U.y[i] - U.y.front() - added.y[i]));
        most = std::max({most, std::abs(U.y[i]), std::abs(added.y[i])});
    }
    return worst / most;
}

real vessel_mass(const RunRecord& run, const Reference&) {
    const Curve liquid = run.series("liquid_mass"), vapour = run.series("vapour_mass");
    real worst = 0;
    for (std::size_t i = 0; i < liquid.size(); ++i)
        if (const real e = std::abs((liquid.y[i] + vapour.y[i]) / (liquid.y[0] + vapour.y[0]) - 1); !(e <= worst)) worst = e;
    return worst;
}

/// The path of the run in the plane of temperature and pressure, beside the table.
Panel path_panel(const RunRecord& run, const Reference& ref) {
    const Curve T = run.series("temperature"), p = run.series("pressure");
    Curve path{.label = "weir"}, table = ref.curve("pressure");
    for (std::size_t i = 0; i < T.size(); ++i)
        if (p.y[i] > 0) path.x.push_back(T.y[i]), path.y.push_back(p.y[i]);
    table.label = "rest (IAPWS)", table.points = true;
    return {.title = "The run's path in the phase diagram",
            .x = {"T [K]"},
            .y = {"p [Pa]", true},
            .curves = {ref.curve("sublimation"), ref.curve("melting"), ref.curve("saturation"), table, path}};
}

}  // namespace

std::vector<Metric> vessel_metrics() {
    std::vector<Metric> list = {
        worst_of("vessel.pressure_error", "Largest relative difference of the pressure at rest from the table's, of all temperatures.",
                 [](const VesselRest& r) { return r.p / r.pressure_in_table - 1; }),
        worst_of("vessel.vapour_error", "The same of the vapour's mass.",
                 [](const VesselRest& r) { return r.vapour / r.vapour_in_table - 1; }),
        {.name = "vessel.heat_error",
         .unit = "",
         .doc = "Largest relative difference of the heat between two rests from mass times the table's difference of energies.",
         .measure = vessel_heat},
        {.name = "vessel.misjudged", .unit = "", .doc = "Rests that are dry and should not be, or the reverse.", .measure = misjudged},
        {.name = "vessel.mass_error",
         .unit = "",
         .doc = "Largest relative difference of the mass of liquid and vapour from that at the start.",
         .measure = vessel_mass},
        {.name = "vessel.balance_error",
         .unit = "",
         .doc = "Largest difference between the energy and what there was and was added, over the largest energy.",
         .measure = vessel_balance}};
    list.front().figure = path_panel;
    return list;
}

}  // namespace weir::validation
