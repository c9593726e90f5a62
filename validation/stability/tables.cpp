// Limits as text.
#include "validation/stability/command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace weir::validation {
namespace {

using nlohmann::json;

std::string name_of(const Stress& s) { return s.method.empty() ? s.name : s.name + ", " + s.method; }

std::string last_stable(const Limit& l) {
    if (!l.last_stable) return fmt::format("< {:g}", l.stress.low);
    return fmt::format("{}{:.3g}", l.first_unstable ? "" : ">= ", *l.last_stable);
}

std::string number(const std::optional<real>& value) { return value ? fmt::format("{:.3g}", *value) : std::string("-"); }

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string what_broke(const Limit& l) {
    if (!l.first_unstable) return "nothing";
    return fmt::format("at {:.3g}, step {}, t = {:.3g} s: {}", *l.first_unstable, l.broke.step, l.broke.time, first_line(l.broke.what));
}

}  // namespace

std::string limits_table(const StressStudy& study, const std::vector<Limit>& limits) {
    std::size_t width = 8;
    for (const Limit& l : limits) width = std::max(width, name_of(l.stress).size());
    std::string s = fmt::format("{}: {}\n", study.name, study.question);
    s += fmt::format("        {:{}}  {:>11} {:>8} {:>8} {:>5} {:>8}  {}\n", "axis", width, "last stable", "theory", "floor", "runs",
                     "seconds", "what broke first");
    for (const Limit& l : limits)
        s += fmt::format("  {:4}  {:{}}  {:>11} {:>8} {:>8} {:>5} {:>8.2f}  {}\n", l.guarded() ? "pass" : "FAIL", name_of(l.stress), width,
                         last_stable(l), number(l.stress.theory), number(l.stress.floor), l.runs, l.seconds, what_broke(l));
    return s;
}

json limits_json(const StressStudy& study, const std::vector<Limit>& limits) {
    json list = json::array();
    for (const Limit& l : limits) {
        json entry = {{"axis", l.stress.name},
                      {"method", l.stress.method},
                      {"key", l.stress.key},
                      {"hard_because", l.stress.hard_because},
                      {"last_stable_text", last_stable(l)},
                      {"broke", what_broke(l)},
                      {"guarded", l.guarded()},
                      {"runs", l.runs},
                      {"seconds", l.seconds}};
        if (l.last_stable) entry["last_stable"] = *l.last_stable;
        if (l.first_unstable) entry["first_unstable"] = *l.first_unstable;
        if (l.stress.theory) entry["theory"] = *l.stress.theory, entry["theory_source"] = l.stress.theory_source;
        if (l.stress.floor) entry["floor"] = *l.stress.floor, entry["floor_why"] = l.stress.floor_why;
        list.push_back(entry);
    }
    return {{"study", study.name}, {"question", study.question}, {"limits", list}};
}

std::string limits_markdown(const json& study) {
    const auto text = [](const json& entry, const char* key) { return entry.value(key, std::string()); };
    const auto number_at = [](const json& entry, const char* key) {
        return entry.contains(key) ? fmt::format("{:.3g}", entry[key].get<double>()) : std::string();
    };
    std::string s = fmt::format("## {}\n\n{}\n\n", text(study, "study"), text(study, "question"));
    s += "| | axis | method | last stable | theory | floor | what broke first | hard because |\n|---|---|---|---|---|---|---|---|\n";
    for (const auto& l : study["limits"]) {
        std::string theory = number_at(l, "theory");
        if (!theory.empty()) theory += fmt::format(" ({})", text(l, "theory_source"));
        s += fmt::format("| {} | {} (`{}`) | {} | {} | {} | {} | {} | {} |\n", l["guarded"].get<bool>() ? "" : "**below its floor**",
                         text(l, "axis"), text(l, "key"), text(l, "method"), text(l, "last_stable_text"), theory, number_at(l, "floor"),
                         text(l, "broke"), text(l, "hard_because"));
    }
    return s + fmt::format("\nCommit {}, on {}.\n\n", study.value("commit", "unknown"), study.value("machine", "unknown"));
}

}  // namespace weir::validation
