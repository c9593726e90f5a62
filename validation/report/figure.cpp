// Which panels a case gets, in reading order.
#include "validation/report/figure.hpp"

#include "validation/harness/generic_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace weir::validation {
namespace {

/// Every metric that some variant claims something about, in the order of the file.
std::vector<std::string> metrics_of(const CaseResult& result) {
    std::vector<std::string> names;
    for (const auto& v : result.variants)
        for (const Criterion& c : v.plan.accept)
            if (std::find(names.begin(), names.end(), c.metric) == names.end()) names.push_back(c.metric);
    return names;
}

/// " [m/s]", as some run knows it.
std::string unit_label(const CaseResult& result, const std::string& metric) {
    for (const auto& v : result.variants)
        for (const RunResult& r : v.runs)
            if (const auto at = r.units.find(metric); at != r.units.end() && !at->second.empty()) return fmt::format(" [{}]", at->second);
    return "";
}

std::string label_of(const VariantResult& v, const std::string& otherwise) { return v.plan.name.empty() ? otherwise : v.plan.name; }

/// One point a run of `metric`, for each variant that swept.
std::vector<Curve> over_runs(const CaseResult& result, const std::string& metric, real (*abscissa)(const RunResult&)) {
    std::vector<Curve> curves;
    for (const auto& v : result.variants) {
        Curve c{.label = label_of(v, "weir")};
        for (const RunResult& r : v.runs)
            if (const auto at = r.measured.find(metric); at != r.measured.end())
                c.x.push_back(abscissa(r)), c.y.push_back(std::abs(at->second));
        if (c.size() > 1) curves.push_back(std::move(c));
    }
    return curves;
}

/// Lines h^p below the lowest error curve, for every order that is claimed.
void add_slopes(Panel& panel, const CaseResult& result, const std::string& metric) {
    std::set<real> orders;
    for (const auto& v : result.variants)
        for (const Criterion& c : v.plan.accept) {
            if (c.is_order() && c.metric == metric) orders.insert(std::round(c.low));
        }
    if (panel.curves.empty()) return;
    const auto lowest =
        std::min_element(panel.curves.begin(), panel.curves.end(), [](const Curve& a, const Curve& b) { return a.y.back() < b.y.back(); });
    const real h0 = lowest->x.front(), h1 = lowest->x.back(), e0 = 0.5 * lowest->y.front();
    for (const real p : orders)
        panel.curves.push_back(
            {.label = fmt::format("slope {:g}", p), .x = {h0, h1}, .y = {e0, e0 * std::pow(h1 / h0, p)}, .dashed = true});
}

std::string sweep_label(const CaseResult& result) {
    for (const auto& v : result.variants)
        if (v.plan.sweep) return v.plan.sweep->key == "grid.cells" ? "mesh width h [m]" : v.plan.sweep->key;
    return "";
}

void add_sweeps(std::vector<Panel>& panels, const CaseResult& result) {
    const auto h = [](const RunResult& r) { return r.h; };
    const auto milliseconds = [](const RunResult& r) { return 1e3 * r.seconds / static_cast<double>(std::max<std::int64_t>(1, r.steps)); };
    for (const std::string& metric : metrics_of(result)) {
        const bool error = quantity_of(metric) == Quantity::error;
        const auto curves = over_runs(result, metric, h);
        if (curves.empty() || metric == "seconds") continue;
        Panel panel{.title = metric, .x = {sweep_label(result), true}, .y = {metric + unit_label(result, metric), error}, .curves = curves};
        add_slopes(panel, result, metric);
        panels.push_back(std::move(panel));
        if (result.plan.kind != Kind::iterations) continue;
        panels.push_back({.title = metric + " against work",
                          .x = {"computing time per step [ms]", true},
                          .y = {metric + unit_label(result, metric), error},
                          .curves = over_runs(result, metric, milliseconds)});
    }
}

/// What the metrics drew of the finest run of each variant: equal titles share a panel, a sweep's too, and the reference's points come
/// once.
void add_profiles(std::vector<Panel>& panels, const CaseResult& result) {
    for (const auto& v : result.variants) {
        if (v.runs.empty()) continue;
        for (const Panel& p : v.runs.back().panels) {
            auto shared = std::find_if(panels.begin(), panels.end(), [&](const Panel& q) { return q.title == p.title; });
            if (shared == panels.end()) shared = panels.insert(panels.end(), {.title = p.title, .x = p.x, .y = p.y});
            for (Curve c : p.curves) {
                const bool ours = !c.points && !c.dashed;
                if (ours && !v.plan.name.empty()) c.label += " " + v.plan.name;
                if (ours && !v.runs.back().label.empty()) c.label += " " + v.runs.back().label;
                const bool known =
                    std::any_of(shared->curves.begin(), shared->curves.end(), [&](const Curve& d) { return d.label == c.label; });
                if (!known) shared->curves.push_back(std::move(c));
            }
        }
    }
}

/// What a series shows: itself, or for a drift its change relative to the start.
Curve shown(Curve series, const std::string& metric) {
    const Metric* m = find_metric(metric);
    if (m && m->measure) series.label = "what " + metric + " is taken from";  // the metric is made of the series, not the series itself
    if (!metric.ends_with(".drift") || series.y.empty()) return series;
    const real first = series.y.front();
    for (real& y : series.y) y = (y - first) / std::abs(first);
    series.label += ", relative change";
    return series;
}

/// Returns whether all curves are round-off about zero: the number in the table says more.
bool is_noise(const Panel& panel) {
    constexpr real round_off = 1e-12;
    return std::all_of(panel.curves.begin(), panel.curves.end(),
                       [](const Curve& c) { return std::all_of(c.y.begin(), c.y.end(), [](real y) { return std::abs(y) < round_off; }); });
}

void add_histories(std::vector<Panel>& panels, const CaseResult& result) {
    std::set<std::string> drawn;
    for (const std::string& metric : metrics_of(result)) {
        Panel panel{.x = {"time t [s]"}};
        for (const auto& v : result.variants) {
            if (v.runs.empty()) continue;
            const auto at = v.runs.back().series.find(metric);
            if (at == v.runs.back().series.end() || at->second.size() < 2) continue;
            Curve c = shown(at->second, metric);
            panel.title = c.label;
            panel.y.label = c.label + unit_label(result, metric);
            c.label = label_of(v, "weir") + (v.runs.back().label.empty() ? "" : " " + v.runs.back().label);
            panel.curves.push_back(std::move(c));
        }
        if (metric.ends_with(".drift") && is_noise(panel)) continue;
        if (!panel.curves.empty() && drawn.insert(panel.title).second) panels.push_back(std::move(panel));
    }
}

/// Measured and bound of each claim, one above the other.
Panel claims(const CaseResult& result) {
    Panel panel{.title = "claims: measured value and bound",
                .x = {"claim, in the order of the table"},
                .y = {"magnitude (unit of each claim)", true}};
    Curve measured{.label = "measured", .points = true}, bound{.label = "bound", .points = true};
    real number = 0;
    for (const auto& v : result.variants)
        for (const Verdict& verdict : v.verdicts) {
            number += 1;
            measured.x.push_back(number), measured.y.push_back(std::abs(verdict.measured));
            for (const real b : {verdict.low, verdict.high})
                if (std::isfinite(b)) bound.x.push_back(number), bound.y.push_back(std::abs(b));
        }
    panel.curves = {measured, bound};
    return panel;
}

}  // namespace

std::vector<Panel> panels_of(const CaseResult& result) {
    std::vector<Panel> panels;
    add_sweeps(panels, result);
    add_profiles(panels, result);
    add_histories(panels, result);
    if (panels.empty()) panels.push_back(claims(result));
    return panels;
}

}  // namespace weir::validation
