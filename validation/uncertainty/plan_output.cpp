// plan.json and the figure of a plan.
#include "output/machine.hpp"
#include "validation/report/svg.hpp"
#include "validation/uncertainty/json_numbers.hpp"
#include "validation/uncertainty/scene_plan.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace weir::validation {
namespace {

using nlohmann::json;

/// One number of a quantity: of several samples their root mean square.
real plotted(const Value& value) { return value.samples.size() == 1 ? value.samples[0] : size_of(value.samples); }

json quantity_json(const QuantityStudy& quantity) {
    json j{{"quantity", quantity.asked.quantity.text},
           {"unit", quantity.values.empty() ? "" : quantity.values.back().unit},
           {"band", json_number(quantity.width)},
           {"band_of_step", quantity.finer * quantity.step},
           {"band_of_seeds", quantity.finer * quantity.seeds},
           {"refused", quantity.refused},
           {"not_refined", quantity.not_refined}};
    if (quantity.band) {
        j["band_of_grid"] = quantity.band->width, j["order"] = quantity.band->order, j["observed_order"] = quantity.band->observed_order;
        j["convergence"] = words_of(quantity.band->convergence);
    }
    return j;
}

json method_json(const PlannedMethod& planned, const ScenePlan& plan) {
    const MethodStudy& study = planned.study;
    json j{{"method", study.method.name},
           {"solver", study.method.solver},
           {"formal_order", study.method.formal_order},
           {"fails", study.solver_fails},
           {"left_out", study.left_out},
           {"seconds", study.spent},
           {"seconds_estimated", study.estimated},
           {"other_equations", planned.other_equations()}};
    j["chaotic_after"] = study.chaotic_after ? json(*study.chaotic_after) : json();
    j["grids"] = json::array(), j["quantities"] = json::array();
    for (std::size_t g = 0; g < study.grids.size(); ++g) {
        const GridRun& run = study.grids[g];
        json row{{"cells", run.grid.cells},
                 {"h", run.grid.h},
                 {"seconds", run.run.seconds},
                 {"steps", run.run.steps},
                 {"seconds_per_frame", study.seconds_per_frame(g, plan.limits.frame)},
                 {"values", json::array()},
                 {"warnings", run.run.warnings}};
        row["failure"] = run.run.failure ? json(*run.run.failure) : json();
        for (const QuantityStudy& q : study.quantities) {
            const bool known = q.values[g].unknown.empty();
            row["values"].push_back({{"value", known ? json_number(plotted(q.values[g])) : json()},
                                     {"error_at_most", g < q.error.size() ? json_number(q.error[g]) : json()},
                                     {"unknown", q.values[g].unknown}});
        }
        j["grids"].push_back(row);
    }
    for (const QuantityStudy& q : study.quantities) j["quantities"].push_back(quantity_json(q));
    if (planned.apart)
        j["apart"] = {{"series", planned.apart->of},
                      {"distance", planned.apart->distance},
                      {"bands", planned.apart->bands},
                      {"z", json_number(planned.apart->z())}};
    return j;
}

std::string axis_title(const std::string& name, const std::string& unit) { return unit.empty() ? name : name + " [" + unit + "]"; }

/// Value with its band against computing time per frame.
Panel values_panel(const ScenePlan& plan, std::size_t q) {
    Panel panel{.title = plan.asked[q].quantity.text, .x = {"computing time per frame [ms]", true}};
    for (const PlannedMethod& m : plan.methods) {
        const MethodStudy& study = m.study;
        if (q >= study.quantities.size()) continue;
        Curve curve{.label = study.method.name};
        for (std::size_t g = 0; g < study.grids.size(); ++g) {
            const Value& value = study.quantities[q].values[g];
            if (!value.unknown.empty() || g >= study.quantities[q].error.size()) continue;
            curve.x.push_back(1e3 * study.seconds_per_frame(g, plan.limits.frame));
            curve.y.push_back(plotted(value));
            curve.half_widths.push_back(study.quantities[q].error[g]);
            panel.y = {axis_title(plan.asked[q].quantity.text, value.unit)};
        }
        if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
    }
    if (plan.limits.budget < infinity) panel.marks.push_back({1e3 * plan.limits.budget, "budget"});
    if (plan.take) panel.marks.push_back({1e3 * plan.take->seconds, "recommended"});
    return panel;
}

/// The finest series of each method.
std::optional<Panel> series_panel(const ScenePlan& plan, std::size_t q) {
    const Asked& asked = plan.asked[q];
    if (asked.is_metric || asked.quantity.kind == Statistic::picture) return std::nullopt;
    Panel panel{.title = asked.quantity.series + ", finest grids", .x = {"t [s]"}};
    for (const PlannedMethod& m : plan.methods) {
        if (m.study.grids.empty() || m.study.grids.back().run.failure) continue;
        const RecordedSeries& series = series_named(m.study.grids.back().run.series, asked.quantity.series);
        panel.curves.push_back(series.curve);
        panel.curves.back().label = m.study.method.name;
        panel.y = {axis_title(asked.quantity.series, series.unit)};
    }
    if (const auto& own = plan.methods.front().study; own.chaotic_after) panel.marks.push_back({*own.chaotic_after, "chaotic"});
    if (panel.curves.empty()) return std::nullopt;
    return panel;
}

}  // namespace

std::string plan_json(const ScenePlan& plan) {
    json j{{"scene", plan.file},
           {"frame", plan.limits.frame},
           {"budget", json_number(plan.limits.budget)},
           {"machine", output::this_machine().processor},
           {"commit", output::this_machine().commit},
           {"cores_of_others", plan.others},
           {"seconds_of_new_runs", plan.spent}};
    j["asked"] = json::array(), j["methods"] = json::array();
    for (std::size_t q = 0; q < plan.asked.size(); ++q)
        j["asked"].push_back({{"quantity", plan.asked[q].quantity.text}, {"error", plan.wishes.empty() ? "" : plan.wishes[q].text}});
    for (const PlannedMethod& m : plan.methods) j["methods"].push_back(method_json(m, plan));
    j["take"] = json();
    if (plan.take)
        j["take"] = {{"method", plan.methods[plan.take->method].study.method.name},
                     {"grid", plan.take->grid},
                     {"seconds_per_frame", plan.take->seconds},
                     {"command", run_line(plan, *plan.take)}};
    return j.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

void draw_plan(const ScenePlan& plan, const std::filesystem::path& svg) {
    std::vector<Panel> panels;
    for (std::size_t q = 0; q < plan.asked.size(); ++q) {
        panels.push_back(values_panel(plan, q));
        if (const auto series = series_panel(plan, q)) panels.push_back(*series);
    }
    draw(gnuplot_program(plan.name, panels), svg);
}

}  // namespace weir::validation
