// Limits as text.
#include "validation/stability/command.hpp"

#include "validation/page/sections.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>

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
    if (!l.first_unstable) return l.stress.unbroken.empty() ? "nothing" : "nothing: " + l.stress.unbroken;
    return fmt::format("at {:.3g}, step {}, t = {:.3g} s: {}", *l.first_unstable, l.broke.step, l.broke.time, first_line(l.broke.what));
}

/// "wet_cells 32, film 0.5"
std::string preconditions_text(const Limit& l) {
    std::string s;
    for (const MeasuredValue& h : l.preconditions) s += fmt::format("{}{} {:.4g}", s.empty() ? "" : ", ", h.quantity, h.value);
    return s;
}

}  // namespace

std::string limits_table(const StressStudy& study, const std::vector<Limit>& limits) {
    std::size_t width = 8;
    for (const Limit& l : limits) width = std::max(width, name_of(l.stress).size());
    std::string s = fmt::format("{}: {}\n", study.name, study.question);
    s += fmt::format("        {:{}}  {:5} {:>12} {:>8} {:>10} {:>5} {:>8}  {}\n", "axis", width, "kind", "stable up to", "theory",
                     "guaranteed", "runs", "seconds", "first failure");
    for (const Limit& l : limits) {
        s += fmt::format("  {:4}  {:{}}  {:5} {:>12} {:>8} {:>10} {:>5} {:>8.2f}  {}", l.passes() ? "pass" : "FAIL", name_of(l.stress),
                         width, name(l.stress.kind), last_stable(l), number(l.stress.theory), number(l.stress.guaranteed), l.runs,
                         l.seconds, what_broke(l));
        s += l.doubt().empty() ? "\n" : fmt::format(" ({})\n", l.doubt());
        if (l.stress.open_target)
            s += fmt::format("        open target {:.3g}, not met: {}\n", *l.stress.open_target, l.stress.not_reached);
    }
    return s;
}

json limits_json(const StressStudy& study, const std::vector<Limit>& limits) {
    json list = json::array();
    for (const Limit& l : limits) {
        json entry = {{"axis", l.stress.name},
                      {"solver", l.stress.solver},
                      {"method", l.stress.method},
                      {"kind", name(l.stress.kind)},
                      {"hardship", preconditions_text(l)},
                      {"doubt", l.doubt()},
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
        if (l.stress.guaranteed) entry["floor"] = *l.stress.guaranteed, entry["floor_why"] = l.stress.guaranteed_why;
        if (l.stress.open_target) entry["asked"] = *l.stress.open_target, entry["not_reached"] = l.stress.not_reached;
        list.push_back(entry);
    }
    return {{"study", study.name}, {"question", study.question}, {"limits", list}, {"maps", json::array()}};
}

namespace {

std::string text(const json& entry, const char* key) { return entry.value(key, std::string()); }

std::string number_cell(const json& entry, const char* key) {
    return entry.contains(key) ? fmt::format("{:.3g}", entry[key].get<double>()) : std::string();
}

std::string key_text(const json& limit) { return text(limit, "key").empty() ? "" : fmt::format(" (`{}`)", text(limit, "key")); }

}  // namespace

std::string limits_markdown(const json& study) {
    std::string s = fmt::format("## {}\n\n{}\n\n", text(study, "study"), text(study, "question"));
    s += "| | axis | method | kind | stable up to | at the limit | theory | guaranteed | first failure | difficulty |\n"
         "|---|---|---|---|---|---|---|---|---|---|\n";
    for (const auto& l : study["limits"]) {
        std::string theory = number_cell(l, "theory");
        if (!theory.empty()) theory += fmt::format(" ({})", text(l, "theory_source"));
        const std::string wrong = l["guarded"].get<bool>() ? text(l, "doubt") : "below its guaranteed range";
        s += fmt::format("| {} | {}{} | {} | {} | {} | {} | {} | {} | {} | {} |\n", wrong.empty() ? "" : "**" + wrong + "**",
                         text(l, "axis"), key_text(l), text(l, "method"), text(l, "kind"), text(l, "last_stable_text"), text(l, "hardship"),
                         theory, number_cell(l, "floor"), text(l, "broke"), text(l, "hard_because"));
    }
    if (study.contains("maps"))
        for (const auto& map : study["maps"])
            s += fmt::format("\n![{}](svg/{})\n\n*Difficulty:* {}.\n", text(map, "name"), map_file(study, map), text(map, "hard_because"));
    return s + fmt::format("\nCommit {}, on {}.\n\n", study.value("commit", "unknown"), study.value("machine", "unknown"));
}

std::string open_targets_markdown(const std::vector<json>& studies) {
    std::string rows;
    for (const json& study : studies)
        for (const auto& l : study["limits"])
            if (l.contains("asked"))
                rows += fmt::format("| [{0}](#{0}) | {1} | {2} | {3} | {4} | {5} | {6} |\n", text(study, "study"), text(l, "axis"),
                                    text(l, "method"), number_cell(l, "asked"), number_cell(l, "last_stable"), number_cell(l, "floor"),
                                    text(l, "not_reached"));
    if (rows.empty()) return "";
    return "## Open targets\n\n| case | axis | method | target | stable up to | guaranteed range | reason not met |\n"
           "|---|---|---|---|---|---|---|\n" +
           rows + "\n";
}

std::string all_limits_markdown(const std::vector<json>& studies) {
    std::vector<std::pair<std::string, std::string>> rows;  // solver, row
    for (const json& study : studies)
        for (const auto& l : study["limits"]) {
            const std::string solver = text(l, "solver");
            const std::string method = text(l, "method");
            rows.push_back({solver, fmt::format("| {} | {} | {} | {} | {} | {} | {} | [{}](#{}) |\n", solver, text(l, "axis"), method,
                                                text(l, "kind"), text(l, "last_stable_text"), number_cell(l, "theory"), text(l, "broke"),
                                                text(study, "study"), text(study, "study"))});
        }
    std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string s =
        "## All limits, by solver\n\nKinds: a limit is raised until an invariant fails. Values of kind units are dimensionally similar: "
        "only an absolute number in the code could make one fail. A guard is checked for taking over or refusing.\n\n"
        "| solver | axis | method | kind | stable up to | theory | first failure | case |\n|---|---|---|---|---|---|---|---|\n";
    for (const auto& row : rows) s += row.second;
    return s + "\n";
}

json map_json(const StressMap& map, const std::vector<std::vector<std::optional<Break>>>& cells, double seconds) {
    json columns = json::array();
    for (const auto& column : cells) {
        columns.push_back(json::array());
        for (const auto& broke : column) {
            json cell = {{"stable", !broke}};
            if (broke)
                cell["kind"] = broke->kind, cell["what"] = first_line(broke->what), cell["step"] = broke->step, cell["time"] = broke->time;
            columns.back().push_back(cell);
        }
    }
    const auto axis = [](const MapAxis& a) { return json{{"key", a.key}, {"label", a.label}, {"values", a.values}}; };
    return {{"name", map.stress.name},
            {"method", map.stress.method},
            {"solver", map.stress.solver},
            {"hard_because", map.stress.hard_because},
            {"x", axis(map.x)},
            {"y", axis(map.y)},
            {"cells", columns},
            {"steps", map.stress.steps},
            {"seconds", seconds}};
}

std::string maps_text(const json& study) {
    std::string s;
    for (const auto& map : study["maps"]) {
        std::vector<std::string> kinds;
        const auto letter = [&](const json& cell) {
            if (cell["stable"].get<bool>()) return '.';
            const std::string kind = text(cell, "kind");
            auto at = std::find(kinds.begin(), kinds.end(), kind);
            if (at == kinds.end()) at = kinds.insert(at, kind);
            return static_cast<char>('a' + (at - kinds.begin()) % 26);
        };
        s += fmt::format("  {} {} [{:.1f} s]\n", text(map, "name"), text(map, "method"), map["seconds"].get<double>());
        for (std::size_t j = map["y"]["values"].size(); j-- > 0;) {
            s += fmt::format("    {:>10} ", map["y"]["values"][j].get<std::string>());
            for (const auto& column : map["cells"]) s += fmt::format("{:>10}", letter(column[j]));
            s += "\n";
        }
        s += fmt::format("    {:>10} ", "");
        for (const auto& x : map["x"]["values"]) s += fmt::format("{:>10}", x.get<std::string>());
        s += "\n";
        for (std::size_t k = 0; k < kinds.size(); ++k) s += fmt::format("    {} {}\n", static_cast<char>('a' + k % 26), kinds[k]);
    }
    return s;
}

}  // namespace weir::validation
