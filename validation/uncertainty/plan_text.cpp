// What weir plan prints of a scene.
#include "validation/uncertainty/scene_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

constexpr double busy = 0.25;  // cores of other programs that are mentioned

std::string milliseconds(double seconds) { return fmt::format("{:.2g} ms", 1e3 * seconds); }

/// The quantity of the scene's own method, for scales and units; null where it has none.
const Value* scale_of(const ScenePlan& plan, std::size_t q) {
    for (const PlannedMethod& m : plan.methods)
        if (q < m.study.quantities.size() && m.study.quantities[q].finest().unknown.empty()) return &m.study.quantities[q].finest();
    return nullptr;
}

std::string wish_text(const ScenePlan& plan, std::size_t q) {
    if (plan.wishes.empty()) return "as accurately as possible";
    const Wish& wish = plan.wishes[q];
    const Value* value = scale_of(plan, q);
    if (!wish.relative || !value) return "to " + wish.text;
    return fmt::format("to {} of {} ({}: {})", wish.text, value->scale_of, text_with_unit(value->scale, value->unit, 0.01 * value->scale),
                       text_with_unit(absolute(wish, *value), value->unit, absolute(wish, *value)));
}

std::string question_text(const ScenePlan& plan) {
    std::string s;
    for (std::size_t q = 0; q < plan.asked.size(); ++q)
        s += fmt::format("{} {}, {}\n", q == 0 ? "asked:" : "      ", plan.asked[q].quantity.text, wish_text(plan, q));
    if (plan.limits.budget < infinity)
        s += fmt::format("       for {} of computing per frame of {}, on one thread\n", milliseconds(plan.limits.budget),
                         milliseconds(plan.limits.frame));
    return s;
}

std::string price_text(const MethodStudy& study) {
    if (study.grids.empty()) return "";
    std::string s = fmt::format("{}: {} grids, {} to {} cells, {} of computing", study.method.name, study.grids.size(),
                                study.grids.front().grid.text(), study.grids.back().grid.text(), seconds_text(study.spent));
    if (study.estimated > 0)
        s += fmt::format(" (estimated: at most {}; {:.2g} times the finest run)", seconds_text(study.estimated),
                         study.spent / std::max(study.grids.back().run.seconds, 1e-9));
    s += "\n";
    if (!study.left_out.empty()) s += "  left out: " + study.left_out + "\n";
    return s;
}

/// "346.8 mm", or of several samples their root mean square.
std::string value_text(const Value& value, real width) {
    if (!value.unknown.empty()) return "-";
    if (value.samples.size() == 1) return text_with_unit(value.samples[0], value.unit, width);
    return "rms " + text_with_unit(size_of(value.samples), value.unit, width);
}

std::string verdict_text(const QuantityStudy& quantity, const MethodStudy& study, std::size_t g) {
    if (study.grids[g].run.failure) return *study.grids[g].run.failure;
    if (!quantity.values[g].unknown.empty()) return quantity.values[g].unknown;
    if (!study.grids[g].run.warnings.empty()) return study.grids[g].run.warnings.front();
    if (g + 1 < study.grids.size()) return "";
    return quantity.band ? std::string(words_of(quantity.band->convergence)) : "";
}

std::string rows(const PlannedMethod& planned, std::size_t q, const ScenePlan& plan) {
    const MethodStudy& study = planned.study;
    std::string s;
    for (std::size_t g = 0; g < study.grids.size(); ++g) {
        const QuantityStudy& quantity = study.quantities[q];
        const bool known = g < quantity.error.size();
        s += fmt::format("{:16}{:>14}  {:>14}  {:>12}  {:>9}   {}\n", study.method.name, study.grids[g].grid.text(),
                         value_text(quantity.values[g], quantity.width),
                         known ? text_with_unit(quantity.error[g], quantity.values[g].unit, quantity.error[g]) : "-",
                         fmt::format("{:.2g}", 1e3 * study.seconds_per_frame(g, plan.limits.frame)), verdict_text(quantity, study, g));
    }
    return s;
}

std::string table(const ScenePlan& plan, std::size_t q) {
    std::string s = fmt::format("\n{}\n{:16}{:>14}  {:>14}  {:>12}  {:>9}\n", plan.asked[q].quantity.text, "method", "cells", "value",
                                "error within", "ms/frame");
    for (const PlannedMethod& m : plan.methods)
        if (m.study.solver_fails.empty()) s += rows(m, q, plan);
    return s;
}

/// Why a method is not recommended, and what else moves its result.
std::string notes(const PlannedMethod& planned, const ScenePlan& plan) {
    const MethodStudy& study = planned.study;
    const std::string name = study.method.name + ": ";
    if (!study.solver_fails.empty()) return name + study.solver_fails + "\n";
    std::string s;
    if (planned.apart) {
        const Apart& a = *planned.apart;
        const std::string gap = text_with_unit(a.distance, a.unit, 0.1 * a.distance), both = text_with_unit(a.bands, a.unit, 0.1 * a.bands);
        const std::string& own = plan.methods.front().study.method.name;
        if (a.z() > 1)
            s += name +
                 fmt::format(
                     "other equations: {} differs from {}'s by {} (RMS), {:.2g} times what both bands allow ({}); no resolution closes "
                     "that: {}\n",
                     a.of, own, gap, a.z(), both, left_out_by(study.method.solver));
        else
            s += name + fmt::format("not told apart from {}: {} differs by {} (RMS) where both bands allow {}\n", own, a.of, gap, both);
    }
    for (const QuantityStudy& quantity : study.quantities) {
        if (!quantity.refused.empty()) s += name + quantity.asked.quantity.text + ": " + quantity.refused + "\n";
        if (quantity.step > 0 || quantity.seeds > 0) {
            const std::string& unit = quantity.finest().unit;
            s += name + fmt::format("band of {}: {} of the grids, {} of the time step", quantity.asked.quantity.text,
                                    text_with_unit(quantity.band ? quantity.band->width : 0, unit, quantity.width),
                                    text_with_unit(quantity.finer * quantity.step, unit, quantity.width));
            s += quantity.seeds > 0
                     ? fmt::format(", {} of the markers' seeds\n", text_with_unit(quantity.finer * quantity.seeds, unit, quantity.width))
                     : "\n";
        }
        for (const auto& key : quantity.not_refined) s += name + "not refined: " + key + "\n";
    }
    return s;
}

std::string finer_text(const ScenePlan& plan) {
    std::string s;
    for (const PlannedMethod& m : plan.methods) {
        const MethodStudy& study = m.study;
        if (m.other_equations() || study.grids.empty() || study.next <= study.grids.back().grid.number) continue;
        const double finer = static_cast<double>(study.next) / study.grids.back().grid.number;
        if (finer >= farthest) {
            s += fmt::format("{} would need more than {:g} times as many cells per axis\n", study.method.name, farthest);
            continue;
        }
        std::vector<std::string> cells;
        for (const int n : study.grids.back().grid.cells) cells.push_back(n > 1 ? fmt::format("{:.0f}", n * finer) : "1");
        s += study.next_seconds > 100 * plan.limits.time_limit
                 ? fmt::format("{}: no grid within reach meets it\n", study.method.name)
                 : fmt::format("{} would need about {} cells: {} of computing\n", study.method.name, fmt::join(cells, " x "),
                               seconds_text(study.next_seconds));
    }
    return s;
}

std::string advice(const ScenePlan& plan) {
    if (!plan.take) {
        std::string s = "no configuration of the ladder meets this:\n";
        for (const PlannedMethod& m : plan.methods)
            for (const QuantityStudy& q : m.study.quantities)
                if (q.refused.empty() && !m.other_equations())
                    s += fmt::format("{} {} is known to {} at {:.2g} ms per frame\n", m.study.method.name, q.asked.quantity.text,
                                     text_with_unit(q.width, q.finest().unit, q.width),
                                     1e3 * m.study.seconds_per_frame(m.study.grids.size() - 1, plan.limits.frame));
        return s + finer_text(plan);
    }
    const MethodStudy& study = plan.methods[plan.take->method].study;
    const std::size_t g = plan.take->grid;
    std::string s = fmt::format("take {}, {} cells, {:.2g} ms per frame on one thread\n", study.method.name, study.grids[g].grid.text(),
                                1e3 * plan.take->seconds);
    for (const QuantityStudy& q : study.quantities)
        s += fmt::format("  {} = {}, error at most {}\n", q.asked.quantity.text, value_text(q.values[g], q.error[g]),
                         text_with_unit(q.error[g], q.values[g].unit, q.error[g]));
    return s + run_line(plan, *plan.take) + "\n";
}

}  // namespace

std::string plan_text(const ScenePlan& plan) {
    std::string s = question_text(plan);
    for (const PlannedMethod& m : plan.methods) s += price_text(m.study);
    for (std::size_t q = 0; q < plan.asked.size(); ++q) s += table(plan, q);
    s += "\n";
    for (const PlannedMethod& m : plan.methods) s += notes(m, plan);
    if (plan.others > busy)
        s += fmt::format(
            "other programs used {:.1f} cores meanwhile: times are computing time of one thread, and may be longer than on a quiet "
            "machine\n",
            plan.others);
    return s + advice(plan);
}

}  // namespace weir::validation
