// What weir plan prints of a scene.
#include "validation/uncertainty/plan_words.hpp"

#include <fmt/format.h>

namespace weir::validation {
namespace {

using namespace plan_words;

std::string question_text(const ScenePlan& plan) {
    std::string s;
    for (std::size_t q = 0; q < plan.asked.size(); ++q)
        s += fmt::format("{} {}, {}\n", q == 0 ? "asked:" : "      ", plan.asked[q].quantity.text, wish_text(plan, q));
    if (const std::string budget = budget_text(plan); !budget.empty()) s += "       " + budget + "\n";
    return s;
}

std::string ladder_text(const MethodStudy& study) {
    if (study.grids.empty()) return "";
    std::string s = study.method.name + ": " + price_text(study) + "\n";
    if (!study.left_out.empty()) s += "  left out: " + study.left_out + "\n";
    return s;
}

std::string note_text(const QuantityStudy& quantity, const MethodStudy& study, std::size_t g) {
    const RecordedRun& run = study.grids[g].run;
    if (run.failure) return *run.failure;
    if (quantity.values[g].unknown.empty() && !run.warnings.empty()) return run.warnings.front();
    return grid_note(quantity, study, g);
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
                         in_milliseconds(study.seconds_per_frame(g, plan.limits.frame)), note_text(quantity, study, g));
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
    if (const std::string comparison = comparison_text(planned, plan); !comparison.empty())
        s += name + comparison + (planned.other_equations() ? fmt::format(": {}", left_out_by(study.method.solver)) : "") + "\n";
    for (const QuantityStudy& quantity : study.quantities) {
        if (!quantity.refused.empty()) s += name + quantity.asked.quantity.text + ": " + quantity.refused + "\n";
        if (const std::string split = band_parts(quantity); !split.empty())
            s += name + fmt::format("band of {}: {}\n", quantity.asked.quantity.text, split);
        for (const auto& key : quantity.not_refined) s += name + "not refined: " + key + "\n";
    }
    return s;
}

std::string advice(const ScenePlan& plan) {
    if (!plan.take) {
        std::string s = "no configuration of the ladder meets this:\n";
        for (const std::string& line : nearest(plan)) s += line + "\n";
        return s;
    }
    const MethodStudy& study = plan.methods[plan.take->method].study;
    const std::size_t g = plan.take->grid;
    std::string s = fmt::format("take {}, {} cells, {} per frame on one thread\n", study.method.name, study.grids[g].grid.text(),
                                milliseconds(plan.take->seconds));
    for (const QuantityStudy& q : study.quantities)
        s += fmt::format("  {} = {}, error at most {}\n", q.asked.quantity.text, value_text(q.values[g], q.error[g]),
                         text_with_unit(q.error[g], q.values[g].unit, q.error[g]));
    return s + run_line(plan, *plan.take) + "\n";
}

}  // namespace

std::string plan_text(const ScenePlan& plan) {
    std::string s = question_text(plan);
    for (const PlannedMethod& m : plan.methods) s += ladder_text(m.study);
    for (std::size_t q = 0; q < plan.asked.size(); ++q) s += table(plan, q);
    s += "\n";
    for (const PlannedMethod& m : plan.methods) s += notes(m, plan);
    if (const std::string others = others_text(plan); !others.empty()) s += others + "\n";
    return s + advice(plan);
}

}  // namespace weir::validation
