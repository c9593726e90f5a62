// The judge: one function a kind of test.
#include "validation/harness/verdict.hpp"

#include "validation/harness/generic_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace weir::validation {
namespace {

using Test = Criterion::Test;

// GCI23 / (r^p GCI12) outside this band: the grids are too coarse for their order to be quoted (NPARC asks for "about 1").
constexpr real asymptotic_low = 0.8, asymptotic_high = 1.25;

/// The runs that a claim rests on.
std::vector<const RunResult*> runs_of(const Criterion& c, const std::vector<RunResult>& runs) {
    std::vector<const RunResult*> chosen;
    for (const RunResult& r : runs)
        if (c.every || c.is_order() || c.experiment || c.test == Test::gci_at_most || (c.at && r.value == *c.at)) chosen.push_back(&r);
    if (chosen.empty() && !runs.empty()) chosen.push_back(&runs.back());
    return chosen;
}

real measured_in(const RunResult& run, const Criterion& c) {
    if (c.is_monotone()) {
        const auto at = run.series.find(c.metric);
        return at == run.series.end() ? std::nan("") : largest_rise(at->second, c.test == Test::never_decreases);
    }
    const auto at = run.measured.find(c.metric);
    return at == run.measured.end() ? std::nan("") : at->second;
}

/// How far outside the bound (negative: inside); NaN counts as farthest.
real excess(real x, const Criterion& c) {
    const real e = std::max(c.low - x, x - c.high);
    return std::isnan(e) ? infinity : e;
}

void judge_values(Verdict& v, const Criterion& c, const std::vector<const RunResult*>& runs) {
    const auto worst = std::max_element(runs.begin(), runs.end(), [&](const RunResult* a, const RunResult* b) {
        return excess(measured_in(*a, c), c) < excess(measured_in(*b, c), c);
    });
    v.measured = measured_in(**worst, c);
    v.at = (*worst)->label;
    v.pass = v.measured >= c.low && v.measured <= c.high;
    if (std::isnan(v.measured)) v.note = "not a number";
}

/// The band of three grids relative to the finest value. It holds for grids that are not asymptotic, too, and is wider then.
void judge_band(Verdict& v, const Criterion& c, const Band& band, const std::vector<RunResult>& runs) {
    v.measured = band.width / std::abs(measured_in(runs.back(), c));
    v.pass = v.measured >= c.low && v.measured <= c.high;
    v.at = runs.back().label;
    if (std::isnan(v.measured))
        v.note = "a value is not a number";
    else if (band.convergence != Convergence::asymptotic)
        v.note = words_of(band.convergence);
}

void judge_orders(Verdict& v, const Criterion& c, const Variant& plan, const std::vector<RunResult>& runs) {
    if (const auto band = band_of(plan, runs, c.metric); band && c.test == Test::gci_at_most) return judge_band(v, c, *band, runs);
    const OrderTable table = order_table(runs, c.metric);
    const Extrapolation x = table.extrapolate(c.formal_order);
    v.measured = c.test == Test::gci_at_most ? x.gci_fine : table.order();
    v.pass = v.measured >= c.low && v.measured <= c.high;
    v.at = runs.back().label;
    if (std::isnan(v.measured)) v.note = "no order can be computed from these grids";
    if (table.quantity() == Quantity::error || runs.size() < 3) return;
    const bool asymptotic = x.monotone && x.asymptotic > asymptotic_low && x.asymptotic < asymptotic_high;
    if (asymptotic) return;
    v.note = fmt::format("not in the asymptotic range (GCI ratio {:.3g}{}): its order may not be quoted", x.asymptotic,
                         x.monotone ? "" : ", oscillating");
    v.pass = false;
}

/// |E| <= 2 u_val, relative to the experiment; u_num from the grids of another variant.
void judge_experiment(Verdict& v, const Criterion& c, const std::vector<RunResult>& runs, const std::vector<VariantResult>& before) {
    real width = 0;
    for (const VariantResult& other : before) {
        if (other.plan.name != c.experiment->grids) continue;
        const auto of_grids = band_of(other.plan, other.runs, c.metric);
        width = of_grids ? of_grids->width : std::nan("");
    }
    std::vector<real> values;
    for (const RunResult& r : runs) values.push_back(measured_in(r, c));
    const ExperimentComparison comparison = compare(values, *c.experiment, width);
    const real scale = std::abs(c.experiment->mean);
    v.measured = comparison.error / scale;
    v.high = comparison.power() / scale, v.low = -v.high;
    v.pass = v.measured >= v.low && v.measured <= v.high && v.high <= c.experiment->power;
    v.note = std::isnan(v.high) ? "a value, or the band of the grids, is not a number" : words_of(comparison, *c.experiment);
}

Verdict judge_one(const Criterion& c, const Variant& plan, const std::vector<RunResult>& runs, const std::vector<VariantResult>& before) {
    Verdict v{.variant = plan.name,
              .metric = c.metric,
              .criterion = std::string(name(c.test)),
              .low = c.low,
              .high = c.high,
              .why = c.why,
              .not_reached = c.not_reached};
    const auto chosen = runs_of(c, runs);
    for (const RunResult* r : chosen) v.seconds += r->seconds;
    const auto failed = std::find_if(chosen.begin(), chosen.end(), [](const RunResult* r) { return r->failure.has_value(); });
    if (chosen.empty() || failed != chosen.end()) {
        v.note = chosen.empty() ? "nothing was run" : *(*failed)->failure;
        v.at = chosen.empty() ? "" : (*failed)->label;
        return v;
    }
    if (c.experiment)
        judge_experiment(v, c, runs, before);
    else if (c.is_order() || c.test == Test::gci_at_most)
        judge_orders(v, c, plan, runs);
    else
        judge_values(v, c, chosen);
    const bool of_finest = !c.experiment && !c.is_order() && !c.is_monotone() && c.test != Test::gci_at_most && v.at == runs.back().label;
    if (const auto band = of_finest ? band_of(plan, runs, c.metric) : std::nullopt) v.band = band->width;
    if (!c.not_reached.empty() && v.pass) v.note = "this open target is met: remove \"not_reached\"";
    return v;
}

}  // namespace

std::string Verdict::bound() const {
    if (criterion == name(Test::agrees_with)) return "<= 2 u_val";  // which is measured with it
    if (criterion.starts_with("never_")) return fmt::format("<= {:.3g} a step", high);
    if (low == -infinity) return fmt::format("<= {:.4g}", high);
    if (high == infinity) return fmt::format(">= {:.4g}", low);
    return fmt::format("in [{:.6g}, {:.6g}]", low, high);
}

std::vector<Verdict> judge(const Variant& plan, const std::vector<RunResult>& runs, const std::vector<VariantResult>& before) {
    std::vector<Verdict> verdicts;
    for (const Criterion& c : plan.accept) verdicts.push_back(judge_one(c, plan, runs, before));
    return verdicts;
}

OrderTable order_table(const std::vector<RunResult>& runs, const std::string& metric) {
    OrderTable table(quantity_of(metric));
    for (const RunResult& r : runs) {
        const auto at = r.measured.find(metric);
        table.add(r.h, at == r.measured.end() ? std::nan("") : at->second);
    }
    return table;
}

std::optional<Band> band_of(const Variant& plan, const std::vector<RunResult>& runs, const std::string& metric) {
    if (!plan.sweep || plan.sweep->key != "grid.cells" || runs.size() < 3 || quantity_of(metric) == Quantity::error) return std::nullopt;
    std::vector<GridValue> grids;
    for (const RunResult& r : runs) {
        const auto at = r.measured.find(metric);
        grids.push_back({r.h, {at == r.measured.end() ? std::nan("") : at->second}});
    }
    std::sort(grids.begin(), grids.end(), [](const GridValue& a, const GridValue& b) { return a.h > b.h; });
    return band(grids, runs.back().formal_order);
}

real largest_rise(const Curve& series, bool falls) {
    real rise = -infinity, scale = 0;
    for (std::size_t i = 0; i < series.y.size(); ++i) {
        if (std::isnan(series.y[i])) return std::nan("");
        scale = std::max(scale, std::abs(series.y[i]));
        if (i > 0) rise = std::max(rise, (falls ? -1 : 1) * (series.y[i] - series.y[i - 1]));
    }
    if (series.y.size() < 2) return std::nan("");  // one value proves nothing about change
    return scale > 0 ? rise / scale : 0;
}

bool CaseResult::pass() const {
    for (const auto& v : variants)
        for (const auto& verdict : v.verdicts)
            if (!verdict.as_said()) return false;
    return !variants.empty();
}

bool CaseResult::bad_input() const {
    for (const auto& v : variants)
        for (const auto& run : v.runs)
            if (run.bad_input) return true;
    return false;
}

double CaseResult::seconds() const {
    double sum = 0;
    for (const auto& v : variants)
        for (const auto& run : v.runs) sum += run.seconds;
    return sum;
}

}  // namespace weir::validation
