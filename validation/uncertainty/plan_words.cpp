#include "validation/uncertainty/plan_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::validation::plan_words {
namespace {

/// The quantity of the first method that knows it, for scales and units; null where none does.
const Value* scale_of(const ScenePlan& plan, std::size_t q) {
    for (const PlannedMethod& m : plan.methods)
        if (q < m.study.quantities.size() && m.study.quantities[q].finest().unknown.empty()) return &m.study.quantities[q].finest();
    return nullptr;
}

/// The grid that would meet the wishes; empty where no finer grid helps.
std::string finer_text(const MethodStudy& study, const Limits& limits) {
    if (study.grids.empty() || study.next <= study.grids.back().grid.number) return "";
    const double finer = static_cast<double>(study.next) / study.grids.back().grid.number;
    if (finer >= farthest) return fmt::format("{} would need more than {:g} times as many cells per axis", study.method.name, farthest);
    if (study.next_seconds > 100 * limits.time_limit) return fmt::format("{}: no grid within reach meets it", study.method.name);
    std::vector<std::string> cells;
    for (const int n : study.grids.back().grid.cells) cells.push_back(n > 1 ? fmt::format("{:.0f}", n * finer) : "1");
    return fmt::format("{} would need about {} cells: {} of computing", study.method.name, fmt::join(cells, " x "),
                       seconds_text(study.next_seconds));
}

}  // namespace

std::string in_milliseconds(double seconds) {
    const double ms = 1e3 * seconds;
    return ms < 99.5 ? fmt::format("{:.2g}", ms) : fmt::format("{:.0f}", ms);
}

std::string milliseconds(double seconds) { return in_milliseconds(seconds) + " ms"; }

std::string wish_text(const ScenePlan& plan, std::size_t q) {
    if (plan.wishes.empty()) return "as accurately as possible";
    const Wish& wish = plan.wishes[q];
    const Value* value = scale_of(plan, q);
    if (!wish.relative || !value) return "to " + wish.text;
    return fmt::format("to {} of {} ({}: {})", wish.text, value->scale_of, text_with_unit(value->scale, value->unit, 0.01 * value->scale),
                       text_with_unit(absolute(wish, *value), value->unit, absolute(wish, *value)));
}

std::string budget_text(const ScenePlan& plan) {
    if (!(plan.limits.budget < infinity)) return "";
    return fmt::format("for {} of computing per frame of {}, on one thread", milliseconds(plan.limits.budget),
                       milliseconds(plan.limits.frame));
}

std::string price_text(const MethodStudy& study) {
    std::string s = fmt::format("{} grids, {} to {} cells, {} of computing", study.grids.size(), study.grids.front().grid.text(),
                                study.grids.back().grid.text(), seconds_text(study.spent));
    if (study.estimated > 0)
        s += fmt::format(" (estimated: at most {}; {:.2g} times the finest run)", seconds_text(study.estimated),
                         study.spent / std::max(study.grids.back().run.seconds, 1e-9));
    return s;
}

std::string value_text(const Value& value, real width) {
    if (!value.unknown.empty()) return "-";
    if (value.samples.size() == 1) return text_with_unit(value.samples[0], value.unit, width);
    return "rms " + text_with_unit(size_of(value.samples), value.unit, width);
}

std::string grid_note(const QuantityStudy& quantity, const MethodStudy& study, std::size_t g) {
    if (!quantity.values[g].unknown.empty()) return quantity.values[g].unknown;
    return g + 1 == study.grids.size() && quantity.band ? std::string(words_of(quantity.band->convergence)) : "";
}

std::string comparison_text(const PlannedMethod& planned, const ScenePlan& plan) {
    if (!planned.apart) return "";
    const Apart& a = *planned.apart;
    const std::string gap = text_with_unit(a.distance, a.unit, 0.1 * a.distance), both = text_with_unit(a.bands, a.unit, 0.1 * a.bands);
    const std::string& own = plan.methods.front().study.method.name;
    if (!planned.other_equations())
        return fmt::format("not told apart from {}: {} differs by {} (RMS) where both bands allow {}", own, a.of, gap, both);
    return fmt::format(
        "other equations: {} differs from {}'s by {} (RMS), {:.2g} times what both bands allow ({}); no resolution closes that", a.of, own,
        gap, a.z(), both);
}

std::string band_parts(const QuantityStudy& quantity) {
    if (!(quantity.step > 0 || quantity.seeds > 0)) return "";
    const std::string& unit = quantity.finest().unit;
    std::string s =
        fmt::format("{} of the grids, {} of the time step", text_with_unit(quantity.band ? quantity.band->width : 0, unit, quantity.width),
                    text_with_unit(quantity.finer * quantity.step, unit, quantity.width));
    if (quantity.seeds > 0)
        s += fmt::format(", {} of the markers' seeds", text_with_unit(quantity.finer * quantity.seeds, unit, quantity.width));
    return s;
}

std::vector<std::string> nearest(const ScenePlan& plan) {
    std::vector<std::string> lines;
    for (const PlannedMethod& m : plan.methods)
        for (const QuantityStudy& q : m.study.quantities)
            if (q.refused.empty() && !m.other_equations())
                lines.push_back(fmt::format("{} {} is known to {} at {} per frame", m.study.method.name, q.asked.quantity.text,
                                            text_with_unit(q.width, q.finest().unit, q.width),
                                            milliseconds(m.study.seconds_per_frame(m.study.grids.size() - 1, plan.limits.frame))));
    for (const PlannedMethod& m : plan.methods)
        if (const std::string finer = finer_text(m.study, plan.limits); !finer.empty() && !m.other_equations()) lines.push_back(finer);
    return lines;
}

std::string others_text(const ScenePlan& plan) {
    if (!(plan.others > busy)) return "";
    return fmt::format(
        "other programs used {:.1f} cores meanwhile: times are computing time of one thread, and may be longer than on a quiet machine",
        plan.others);
}

}  // namespace weir::validation::plan_words
