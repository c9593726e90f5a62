// Lines and states of a substance, as the solver "phase_diagram" shows them, against tables.
#include "validation/metrics/lists.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace weir::validation {
namespace {

const std::vector<real>& of_samples(const RunRecord& run, const char* name, std::vector<real>& copy) {
    const FieldView* field = run.fields.find("samples", name);
    if (!field) throw BadInput(std::string("the run shows no samples of ") + name);
    copy.assign(field->data.at(0).begin(), field->data.at(0).end());
    return copy;
}

/// Largest relative difference of `column` from the table, over all its points; each must be among the samples. Points without a value (a
/// line that does not run there) are skipped.
real table_error(const RunRecord& run, const Curve& table, const char* at, const char* column) {
    std::vector<real> x, y;
    of_samples(run, at, x), of_samples(run, column, y);
    real worst = table.size() > 0 ? 0 : std::nan("");
    for (std::size_t k = 0; k < table.size(); ++k) {
        if (std::isnan(table.y[k])) continue;
        const auto found = std::find(x.begin(), x.end(), table.x[k]);
        const real error = found == x.end() ? std::nan("") : std::abs(y[static_cast<std::size_t>(found - x.begin())] / table.y[k] - 1);
        if (!(error <= worst)) worst = error;  // NaN stays
    }
    return worst;
}

/// States of the table that no sample has, or another one.
real misplaced(const RunRecord& run, const Reference& ref) {
    const Curve& known = ref.curve("states");
    std::vector<real> T, p, state;
    of_samples(run, "given_temperature", T), of_samples(run, "given_pressure", p), of_samples(run, "state", state);
    real wrong = 0;
    for (std::size_t k = 0; k < known.size(); ++k) {
        const real at = std::strtod(known.names[k].c_str(), nullptr);
        bool right = false;
        for (std::size_t i = 0; i < T.size(); ++i) right = right || (T[i] == known.x[k] && p[i] == at && state[i] == known.y[k]);
        wrong += right ? 0 : 1;
    }
    return wrong;
}

/// How far `column` is from `value` where the temperature is T, relative; NaN where no sample is there.
real at_temperature(const RunRecord& run, real T, const char* column, real value) {
    return table_error(run, {.x = {T}, .y = {value}}, "given_temperature", column);
}

real triple_error(const RunRecord& run, const Reference& ref) {
    real worst = 0;
    for (const char* line : {"sublimation_pressure", "melting_pressure", "saturation_pressure"}) {
        const real error = at_temperature(run, ref.number("triple.T"), line, ref.number("triple.p"));
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

real critical_error(const RunRecord& run, const Reference& ref) {
    const real T = ref.number("critical.T"), rho = ref.number("critical.density");
    real worst = at_temperature(run, T, "saturation_pressure", ref.number("critical.p"));
    for (const char* density : {"liquid_density", "vapour_density"}) {
        const real error = at_temperature(run, T, density, rho);
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

real round_trip(const RunRecord& run, const Reference&) {
    std::vector<real> T, back;
    of_samples(run, "given_temperature", T), of_samples(run, "temperature_of_enthalpy", back);
    real worst = T.empty() ? std::nan("") : 0;
    for (std::size_t i = 0; i < T.size(); ++i) worst = std::max(worst, std::abs(back[i] / T[i] - 1));
    return worst;
}

/// The samples of one state.
Curve samples_of(const RunRecord& run, const char* label, real number) {
    std::vector<real> T, p, state;
    of_samples(run, "given_temperature", T), of_samples(run, "given_pressure", p), of_samples(run, "state", state);
    Curve curve{.label = label, .points = true};
    for (std::size_t i = 0; i < T.size(); ++i)
        if (state[i] == number) curve.x.push_back(T[i]), curve.y.push_back(p[i]);
    return curve;
}

/// Lines of the run, points of the tables.
Panel diagram(const RunRecord& run, const Reference& ref) {
    Panel panel{.title = "The states of " + run.scene->text("substance.name"), .x = {"T [K]"}, .y = {"p [Pa]", true}};
    for (const char* line : {"sublimation", "melting", "saturation"}) {
        const FieldView* field = run.fields.find(line, "position");
        if (!field) continue;
        Curve ours{.label = line};
        for (std::size_t i = 0; i < field->data[0].size(); ++i)
            ours.x.push_back(field->data[0][i]), ours.y.push_back(std::pow(10, field->data[1][i]));
        panel.curves.push_back(std::move(ours));
        const auto table = ref.curves.find(std::string(line) + "_pressure");
        if (table == ref.curves.end()) continue;
        panel.curves.push_back(table->second);
        panel.curves.back().points = true;
    }
    return panel;
}

Panel states(const RunRecord& run, const Reference&) {
    Panel panel = diagram(run, {});
    panel.title = "Where it is what";
    for (Curve& line : panel.curves) line.dashed = true;
    real number = 0;
    for (const char* state : {"solid", "liquid", "vapour", "supercritical"}) panel.curves.push_back(samples_of(run, state, number++));
    return panel;
}

Metric line_metric(const char* name, const char* doc, const char* at, std::vector<const char*> columns) {
    return {.name = name, .unit = "", .doc = doc, .measure = [at, columns](const RunRecord& run, const Reference& ref) {
                real worst = 0;
                for (const char* column : columns) {
                    const real error = table_error(run, ref.curve(column), at, column);
                    if (!(error <= worst)) worst = error;
                }
                return worst;
            }};
}

}  // namespace

std::vector<Metric> substance_metrics() {
    std::vector<Metric> list{
        line_metric("diagram.saturation_error", "Largest relative difference of the pressure of saturation from the table.",
                    "given_temperature", {"saturation_pressure"}),
        line_metric("diagram.sublimation_error", "The same of sublimation.", "given_temperature", {"sublimation_pressure"}),
        line_metric("diagram.melting_error", "The same of melting.", "given_temperature", {"melting_pressure"}),
        line_metric("diagram.density_error", "The same of the densities of liquid and vapour on the line of saturation.",
                    "given_temperature", {"liquid_density", "vapour_density"}),
        line_metric("diagram.latent_heat_error", "The same of the heat of vaporisation.", "given_temperature", {"heat_of_vaporisation"}),
        line_metric("diagram.boiling_error", "The same of the temperature of boiling at given pressures.", "given_pressure",
                    {"boiling_temperature"}),
        {.name = "diagram.misplaced",
         .unit = "",
         .doc = "How many of the tabled states are another one.",
         .measure = misplaced,
         .figure = states},
        {.name = "diagram.triple_error",
         .unit = "",
         .doc = "How far the three lines miss the triple point, relative in pressure.",
         .measure = triple_error},
        {.name = "diagram.critical_error",
         .unit = "",
         .doc = "How far pressure and densities miss the critical point, relative.",
         .measure = critical_error},
        {.name = "diagram.round_trip",
         .unit = "",
         .doc = "Largest relative difference of a sample's temperature from that of its enthalpy.",
         .measure = round_trip},
    };
    list.front().figure = diagram;
    return list;
}

}  // namespace weir::validation
