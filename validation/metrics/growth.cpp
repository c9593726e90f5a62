// Buoyant flow: how far a thermal's centre or a plume's front has risen, and the exponent with which it goes on rising.
#include "validation/harness/fitting.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

constexpr real front_excess = 0.1;  // of the hottest: what counts as the plume
constexpr real early = 0.1;         // of the radius: a thermal that has risen no further has not yet changed its shape
constexpr real late_from = 0.4;     // of the run: the start is forgotten

struct Excess {
    const FieldView& temperature;
    real ambient;
    real operator()(std::size_t i) const { return temperature.data[0][i] - ambient; }
};
Excess excess(const FieldSet& fields, const scene::Scene& scene) {
    const FieldView* T = fields.find("", "temperature");
    if (!T) throw BadInput("the solver shows no field \"temperature\"");
    return {*T, needed_effect(scene, "buoyancy").number("ambient")};
}

/// Height of the centre of the heat.
real centre_height(const FieldSet& fields, const scene::Scene& scene, real) {
    const Excess q = excess(fields, scene);
    real sum = 0, moment = 0;
    for_each_sample(fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) { sum += q(i), moment += q(i) * x[1]; });
    return moment / sum;
}

/// Top of the highest cell that holds a tenth of the largest excess.
real front_height(const FieldSet& fields, const scene::Scene& scene, real) {
    const Excess q = excess(fields, scene);
    real hottest = 0, top = fields.grid.origin[1];
    for_each_sample(fields.grid, -1, [&](const Vec<3>&, real, std::size_t i) { hottest = std::max(hottest, q(i)); });
    for_each_sample(fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) {
        if (hottest > 0 && q(i) > front_excess * hottest) top = std::max(top, x[1] + fields.grid.spacing[1] / 2);
    });
    return top;
}

Curve above(Curve c, real level) {
    for (auto& y : c.y) y -= level;
    c.label = "weir";
    return c;
}

/// Centre of the thermal above the virtual origin that the reference states.
Curve rise(const RunRecord& run, const Reference& ref, const std::string& metric) {
    return above(run.series(metric), ref.number("origin"));
}

/// Height of a plume's front against the length that the heat so far and the time make, (beta Q t^2)^(1/(D+1)): how much a source gives
/// depends on the draught that it makes, so the heat is measured, not assumed to grow with t.
Curve height_against_heat(const RunRecord& run, const Reference& ref) {
    Curve c = rise(run, ref, "plume.exponent_error");
    const Curve heat = run.series("total_temperature");
    const real beta = needed_effect(*run.scene, "buoyancy").number("beta");
    for (std::size_t i = 0; i < c.size(); ++i)
        c.x[i] = std::pow(std::max(0.0, beta * (heat.y[i] - heat.y[0]) * c.x[i] * c.x[i]), 1.0 / (run.scene->dim() + 1));
    return c;
}

Panel growth_panel(const Curve& c, std::string title) {
    return {.title = std::move(title), .x = {"t [s]", true}, .y = {"height [m]", true}, .curves = {c}};
}

real late_exponent(const Curve& c) { return power_law(c, late_from * c.x.back(), c.x.back()); }

/// From a first move of a hundredth of `early` (marks of the grid) to `early` radii.
real early_exponent(const RunRecord& run, const Reference& ref) {
    Curve c = run.series("thermal.early_exponent_error");
    c = above(c, c.y.front());
    std::size_t end = 0;
    while (end < c.size() && c.y[end] < early * ref.number("radius")) ++end;
    return power_law(c, 0.2 * c.x.at(std::min(end, c.size() - 1)), c.x.at(std::min(end, c.size() - 1)));
}

}  // namespace

std::vector<Metric> growth_metrics() {
    return {
        {.name = "thermal.exponent_error",
         .unit = "",
         .doc = "Relative error of the exponent of height against time over the later part of the run.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return std::abs(late_exponent(rise(run, ref, "thermal.exponent_error")) / ref.number("exponent") - 1);
             },
         .figure = [](const RunRecord& run,
                      const Reference& ref) { return growth_panel(rise(run, ref, "thermal.exponent_error"), "Rise of the thermal"); },
         .observe = centre_height},
        {.name = "plume.exponent_error",
         .unit = "",
         .doc = "Relative error of the exponent 1 of the front's height against (F t^2)^(1/(D+1)), F the heat put in so far.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return std::abs(late_exponent(height_against_heat(run, ref)) / ref.number("exponent") - 1);
             },
         .observe = front_height},
        {.name = "thermal.early_exponent_error",
         .unit = "",
         .doc = "Relative error of the exponent 2 with which a thermal leaves rest, while it has moved under a tenth of its radius.",
         .measure = [](const RunRecord& run, const Reference& ref) { return std::abs(early_exponent(run, ref) / 2 - 1); },
         .observe = centre_height},
        {.name = "thermal.acceleration_error",
         .unit = "",
         .doc = "Relative error of the first acceleration of the thermal's centre.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve c = run.series("thermal.acceleration_error");
                 std::size_t i = 0;
                 while (i + 1 < c.size() && c.y[i] - c.y[0] < early * ref.number("radius") / 4) ++i;
                 return std::abs(2 * (c.y[i] - c.y[0]) / (c.x[i] * c.x[i]) / ref.number("acceleration") - 1);
             },
         .observe = centre_height},
    };
}

}  // namespace weir::validation
