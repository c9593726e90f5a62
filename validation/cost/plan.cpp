#include "validation/cost/plan.hpp"

#include "core/error.hpp"
#include "output/machine.hpp"
#include "validation/cost/calibrate.hpp"
#include "validation/report/command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace weir::validation {
namespace {

const Variant* method_of(const Study& study, const CostCurve& curve) {
    for (const Variant& v : study.methods)
        if (v.name == curve.method) return &v;
    return nullptr;
}

std::string setting_text(const Choice& c, const Study& study) {
    const Variant* method = method_of(study, *c.curve);
    if (!method || !method->sweep) return c.curve->method.empty() ? "the only configuration" : c.curve->method;
    const std::string& key = method->sweep->key;
    std::string also;
    for (const auto& follower : method->sweep->also) also += fmt::format(" ({} varies with it)", follower.key);
    return fmt::format("{}{}{} = {:g}{}{}", c.curve->method, c.curve->method.empty() ? "" : ", ", key, c.at.setting,
                       key == "grid.cells" ? fmt::format(" along {}", "xyz"[method->sweep->axis]) : "", also);
}

std::string priced_text(const Choice& c, const Study& study) {
    const bool by_step = study.price == Price::step;
    const std::string step = fmt::format("{:.3g} ms per step", c.at.ms_per_step);
    return fmt::format("{}: {} {:.4g}, {}, {} thread{}", setting_text(c, study), study.error, c.at.error,
                       by_step ? step : fmt::format("{:.3g} ms per frame ({})", 1e3 * c.seconds, step), c.at.threads,
                       c.at.threads == 1 ? "" : "s");
}

/// What stands beside a table: on what it was measured.
nlohmann::json about_table(const PlanOptions& options, const std::string& name) {
    for (const auto& file : {options.tables / "json" / (name + ".json"), options.tables / (name + ".json")}) {
        std::ifstream in(file);
        if (auto tables = nlohmann::json::parse(in, nullptr, false); tables.is_object()) return tables;
    }
    return nlohmann::json::object();
}

/// The curves as this machine would have them, and where their milliseconds come from, in words.
struct PricedHere {
    std::vector<CostCurve> curves;
    std::string words;
};
PricedHere priced_here(const PlanOptions& options, const Study& study, std::vector<CostCurve> curves, const Solvers& solvers) {
    const nlohmann::json about = about_table(options, study.name);
    const std::string there = about.value("machine", "an unnamed machine"), here = output::this_machine().processor;
    std::string words = fmt::format("measured on {}, commit {}", there, about.value("commit", "unknown"));
    if (there.find(here) != std::string::npos) return {std::move(curves), words + "\n"};
    if (options.as_measured) return {std::move(curves), words + fmt::format("; the times were not measured on this machine ({})\n", here)};
    const Calibration c = calibrate(study, curves, solvers);
    words += fmt::format("; this machine is {}\ntimes scaled by {:.2g} to {:.2g}: {} of {} methods measured again here, in {:.2g} s\n",
                         here, c.least, c.most, c.measured, curves.size(), c.seconds);
    return {scaled(std::move(curves), c), words};
}

std::string budget_text(const Study& study, const Budget& budget) {
    const std::string of = study.price == Price::step ? "step" : fmt::format("frame of {:.3g} ms", 1e3 * budget.frame);
    const std::string error =
        budget.error < infinity ? fmt::format("{} at most {:g}", study.error, budget.error) : fmt::format("the smallest {}", study.error);
    std::string text = fmt::format("{}: {}", study.name, error);
    text += budget.seconds < infinity ? fmt::format(" within {:g} ms of computing per {}\n", 1e3 * budget.seconds, of)
                                      : ", at the lowest cost\n";
    if (budget.known_to > 0 && (budget.error < budget.known_to || budget.error == infinity))
        text += fmt::format("reference uncertainty {:g}: smaller errors cannot be distinguished ({})\n", budget.known_to, study.known_why);
    return text;
}

Budget budget_of(const PlanOptions& options, const Study& study) {
    Budget budget{.known_to = study.known_to};
    if (!options.budget.empty()) budget.seconds = parse_seconds(options.budget);
    if (!options.error.empty()) budget.error = parse_error(options.error);
    if (!options.frame.empty()) budget.frame = parse_seconds(options.frame);
    return budget;
}

}  // namespace

std::string shell_word(const std::string& text) {
    static constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./=,:@%";
    if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::string run_line(const Study& study, const CostCurve& curve, const Priced& at, const Solvers& solvers) {
    const Variant* method = method_of(study, curve);
    if (!method) throw BadInput(fmt::format("{} has no method {}", study.name, curve.method));
    const scene::Scene scene = scene_of(*method, at.index, scene::schemas_of(solvers));
    std::string line = "weir run " + shell_word(scene.file());
    for (const auto& change : scene.overrides()) line += " --set " + shell_word(change.key + "=" + change.value);
    line += fmt::format(" --threads {} --measure {}", at.threads, shell_word(study.error));
    if (!method->reference.empty()) line += " --reference " + shell_word(method->reference);
    return line;
}

Plan make_plan(const PlanOptions& requested, const Solvers& solvers) {
    PlanOptions options = requested;
    if (options.tables.empty()) options.tables = published("cost");
    if (options.error.empty() && options.budget.empty())
        throw BadInput("weir plan requires --error, the largest error (2%), or --budget, the computing time per frame (16ms), or both");
    const auto folder = find_case(options.name);
    Plan plan;
    plan.study = read_study(folder, size_of_table(folder.filename().string(), options.tables));
    plan.budget = budget_of(options, plan.study);
    PricedHere here = priced_here(options, plan.study, read_cost_table(plan.study, options.tables), solvers);
    plan.curves = std::move(here.curves), plan.prices = std::move(here.words);
    plan.recommendation = recommend(plan.curves, plan.study.price, plan.budget);
    return plan;
}

int plan_command(const PlanOptions& options, const Solvers& solvers) {
    const Plan plan = make_plan(options, solvers);
    const Recommendation& r = plan.recommendation;
    fmt::print("{}", budget_text(plan.study, plan.budget));
    const auto show = [&](const char* before, const Choice& c) {
        fmt::print("{}{}\n{}\n", before, priced_text(c, plan.study), run_line(plan.study, *c.curve, c.at, solvers));
    };
    if (r.take) {
        show("take ", *r.take);
    } else {
        fmt::print("no configuration of the table meets the request; the nearest:\n");
        for (const Choice& c : r.nearest) show("", c);
    }
    if (r.between) fmt::print("estimate: {}: interpolated between two configurations, not measured\n", priced_text(*r.between, plan.study));
    fmt::print("{}", plan.prices);
    return r.take ? exit_success : exit_claim_failed;
}

}  // namespace weir::validation
