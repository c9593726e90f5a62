// Fixed-width tables for people, CSV and JSON for programs.
#include "validation/report/tables.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace weir::validation {
namespace {

std::string claim_of(const Verdict& v) {
    std::string s = v.variant.empty() ? v.metric : v.variant + ": " + v.metric;
    if (v.criterion.starts_with("order")) s += " order";
    if (v.criterion.starts_with("gci")) s += " GCI";
    if (v.criterion.starts_with("never")) s += v.criterion == "never_increases" ? " never increases" : " never decreases";
    if (!v.at.empty()) s += " at " + v.at;
    return s;
}

/// Whether the case claims an order of this metric: that of others (what round-off leaves) is noise.
bool has_order(const VariantResult& v, const std::string& metric) {
    return std::any_of(v.plan.accept.begin(), v.plan.accept.end(),
                       [&](const Criterion& c) { return c.metric == metric && (c.is_order() || c.test == Criterion::Test::gci_at_most); });
}

bool ordered(const VariantResult& v) { return v.plan.sweep && v.plan.sweep->key == "grid.cells" && v.runs.size() > 1; }

/// Metrics measured in every run of a variant.
std::vector<std::string> metrics_of(const VariantResult& v) {
    std::vector<std::string> names;
    for (const auto& [metric, value] : v.runs.front().measured)
        if (std::all_of(v.runs.begin(), v.runs.end(), [&name = metric](const RunResult& r) { return r.measured.count(name) != 0; }))
            names.push_back(metric);
    return names;
}

nlohmann::json bound_json(const Verdict& v) {
    if (v.low == -infinity) return v.high;
    if (v.high == infinity) return v.low;
    return {v.low, v.high};
}

}  // namespace

std::string claims_table(const CaseResult& result) {
    std::vector<const Verdict*> all;
    std::size_t width = 20;
    for (const auto& v : result.variants)
        for (const Verdict& verdict : v.verdicts) all.push_back(&verdict), width = std::max(width, claim_of(verdict).size());
    std::string s =
        fmt::format("{} ({}, {}): {}\n", result.plan.name, name(result.plan.kind), name(result.plan.size), result.plan.question);
    s += fmt::format("         {:{}}  {:>11}  {:22}  {:>8}  {}\n", "claim", width, "measured", "bound", "seconds", "rationale");
    for (const Verdict* v : all) {
        s += fmt::format("  {:5}  {:{}}  {:>11.4g}  {:22}  {:>8.2f}  {}\n", v->word(), claim_of(*v), width, v->measured, v->bound(),
                         v->seconds, v->why);
        if (!v->not_reached.empty()) s += fmt::format("         open target, not met: {}\n", v->not_reached);
        if (!v->note.empty()) s += fmt::format("         {}\n", v->note);
    }
    return s;
}

std::string unreported_failures(const CaseResult& result) {
    std::string s;
    for (const auto& v : result.variants)
        for (const RunResult& run : v.runs) {
            const auto tells = [&](const Verdict& verdict) { return verdict.at == run.label && verdict.note == *run.failure; };
            if (!run.failure || std::any_of(v.verdicts.begin(), v.verdicts.end(), tells)) continue;
            s += fmt::format("{}{}{}{}: {}: {}\n", result.plan.name, v.plan.name.empty() ? "" : ", ", v.plan.name,
                             v.plan.sweep ? fmt::format(" at {} = {}", v.plan.sweep->key, run.label) : "",
                             run.bad_input ? "refused" : "did not finish", *run.failure);
        }
    return s;
}

std::string orders_table(const CaseResult& result) {
    std::string s;
    for (const auto& v : result.variants) {
        if (!ordered(v)) continue;
        for (const std::string& metric : metrics_of(v)) {
            if (!has_order(v, metric)) continue;
            const OrderTable table = order_table(v.runs, metric);
            s += fmt::format("  {}{}{}\n    {:>12} {:>14} {:>7}\n", v.plan.name, v.plan.name.empty() ? "" : ": ", metric, "h", "measured",
                             "order");
            for (const auto& row : table.rows()) s += fmt::format("    {:>12.6g} {:>14.6g} {:>7.2f}\n", row.h, row.value, row.order);
            const Extrapolation x = table.extrapolate();
            if (v.runs.size() > 2)
                s += fmt::format("    h = 0: {:.6g} (order {:.2f}), GCI {:.3g}, GCI ratio {:.3f}{}\n", x.limit, x.order, x.gci_fine,
                                 x.asymptotic, x.monotone ? "" : ", oscillating");
            if (const auto band = band_of(v.plan, v.runs, metric))
                s += fmt::format("    finest grid: {:.6g} +- {:.2g} ({})\n", table.rows().back().value, band->width,
                                 words_of(band->convergence));
        }
    }
    return s;
}

std::string csv(const CaseResult& result) {
    std::string s = fmt::format("# {} at {} size. {}\n", result.plan.name, name(result.plan.size), result.source);
    s += "variant,value,h,metric,measured,order,limit,gci,gci_ratio,seconds,steps,band\n";
    for (const auto& v : result.variants)
        for (const RunResult& run : v.runs)
            for (const auto& [metric, measured] : run.measured) {
                std::string order = ",,,", band;
                if (const auto width = &run == &v.runs.back() ? band_of(v.plan, v.runs, metric) : std::nullopt)
                    band = fmt::format("{:.6g}", width->width);
                if (ordered(v) && has_order(v, metric)) {
                    const OrderTable table = order_table(v.runs, metric);
                    const auto row = std::find_if(table.rows().begin(), table.rows().end(), [&](const auto& r) { return r.h == run.h; });
                    const Extrapolation x = &run == &v.runs.back() ? table.extrapolate() : Extrapolation{};
                    const auto cell = [](real value) { return std::isnan(value) ? std::string() : fmt::format("{:.6g}", value); };
                    order = fmt::format("{},{},{},{}", cell(row->order), cell(x.limit), cell(x.gci_fine), cell(x.asymptotic));
                }
                s += fmt::format("{},{},{:.9g},{},{:.9g},{},{:.3f},{},{}\n", v.plan.name, run.label, run.h, metric, measured, order,
                                 run.seconds, run.steps, band);
            }
    return s;
}

nlohmann::json verdicts_json(const CaseResult& result) {
    auto list = nlohmann::json::array();
    for (const auto& v : result.variants)
        for (const Verdict& verdict : v.verdicts)
            list.push_back({{"case", result.plan.name},
                            {"variant", verdict.variant},
                            {"kind", name(result.plan.kind)},
                            {"size", name(result.plan.size)},
                            {"metric", verdict.metric},
                            {"criterion", verdict.criterion},
                            {"at", verdict.at},
                            {"measured", verdict.measured},
                            {"band", verdict.band},
                            {"bound", bound_json(verdict)},
                            {"pass", verdict.pass},
                            {"seconds", verdict.seconds},
                            {"claim", claim_of(verdict)},
                            {"bound_text", verdict.bound()},
                            {"why", verdict.why},
                            {"not_reached", verdict.not_reached},
                            {"note", verdict.note},
                            {"frames", frames_folder(result.plan, v.plan, v.runs.size() - 1).string()},
                            {"source", result.source},
                            {"question", result.plan.question},
                            {"blind_to", result.plan.blind_to}});
    return list;
}

}  // namespace weir::validation
