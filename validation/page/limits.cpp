#include "validation/page/sections.hpp"

#include "validation/page/text.hpp"
#include "validation/page/thin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace weir::validation {
namespace {

using nlohmann::json;

std::string axis_of(const json& limit) {
    const std::string method = text_at(limit, "method");
    return text_at(limit, "axis") + (method.empty() ? "" : ", " + method);
}

HtmlTable::Cell last_stable(const json& limit) {
    const auto at = number_at(limit, "last_stable");
    const bool open = !limit.contains("first_unstable");
    return {.html = at ? (open ? "≥ " : "") + number_text(*at) : escaped(text_at(limit, "last_stable_text")),
            .key = at.value_or(0),
            .number = true};
}

void add_rows(HtmlTable& table, const json& study) {
    for (const json& l : study["limits"]) {
        const bool guarded = l.value("guarded", true);
        const std::string doubt = text_at(l, "doubt").empty() ? "" : " <b class=\"no\">" + escaped(text_at(l, "doubt")) + "</b>";
        const std::string there = text_at(l, "hardship").empty() ? "" : "<br>at the limit: " + escaped(text_at(l, "hardship"));
        std::string theory = number_at(l, "theory") ? number_text(*number_at(l, "theory")) : "–";
        if (!text_at(l, "theory_source").empty())
            theory = "<span class=\"theory\">" + theory + ": " + escaped(text_at(l, "theory_source")) + "</span>";
        table.row(
            {word(text_at(l, "solver").empty() ? text_at(study, "study") : text_at(l, "solver")),
             word(axis_of(l)),
             word(text_at(l, "kind")),
             last_stable(l),
             {.html = theory, .key = number_at(l, "theory")},
             {.html = (number_at(l, "floor") ? number_text(*number_at(l, "floor")) : "–") + (guarded ? "" : " <b class=\"no\">not met</b>"),
              .key = number_at(l, "floor"),
              .number = true},
             raw("<span class=\"why\">" + escaped(text_at(l, "broke")) + there + "</span>" + doubt),
             word(text_at(study, "study"))},
            guarded && doubt.empty() ? "" : "fail");
    }
}

/// Open targets beyond the guaranteed range, with the last stable value of each.
std::string not_reached(const std::vector<json>& studies) {
    HtmlTable table({"case", "parameter raised", "target", "stable up to", "guaranteed", "reason not met"},
                    "Open targets: limits that are not met");
    bool any = false;
    for (const json& study : studies)
        for (const json& l : study["limits"]) {
            if (!l.contains("asked")) continue;
            any = true;
            table.row({word(text_at(study, "study")), word(axis_of(l)), value(number_at(l, "asked")), last_stable(l),
                       value(number_at(l, "floor")), word(text_at(l, "not_reached"))});
        }
    return any ? "<h3 id=\"asked-limits\">Open targets</h3>\n" + table.html() : "";
}

/// Each axis once, with what makes it hard.
std::string reasons(const std::vector<json>& studies) {
    std::string list;
    std::set<std::string> told;
    for (const json& study : studies)
        for (const json& l : study["limits"]) {
            const std::string one = fmt::format("<li><b>{}</b> ({}): {}</li>", escaped(text_at(l, "axis")),
                                                escaped(text_at(study, "study")), escaped(text_at(l, "hard_because")));
            if (told.insert(one).second) list += one;
        }
    return "<details><summary>Difficulty of each axis</summary><ul class=\"reasons\">" + list + "</ul></details>\n";
}

/// Limits that theory has a word on, one line an axis: what was found, over all methods, beside the estimate.
std::string beside_theory(const std::vector<json>& studies) {
    struct Found {
        double least, most, theory;
    };
    std::map<std::string, Found> axes;
    for (const json& study : studies)
        for (const json& l : study["limits"]) {
            if (!l.contains("theory") || !l.contains("first_unstable") || !l.contains("last_stable")) continue;
            const double found = *number_at(l, "last_stable"), theory = *number_at(l, "theory");
            const std::string name = fmt::format("{}, {} ({:.3g})", text_at(l, "solver"), text_at(l, "axis"), theory);
            auto& axis = axes.try_emplace(name, Found{found, found, theory}).first->second;
            axis.least = std::min(axis.least, found), axis.most = std::max(axis.most, found);
        }
    std::string list;
    for (const auto& [name, f] : axes)
        list += fmt::format("<li>{}: stable up to {}{}, theory {}</li>", escaped(name.substr(0, name.find(" ("))), number_text(f.least),
                            f.most > f.least ? " to " + number_text(f.most) : std::string(), number_text(f.theory));
    return list.empty() ? "" : "<ul>" + list + "</ul>";
}

}  // namespace

void Counts::add(const json& limit) {
    const std::string kind = text_at(limit, "kind");
    const bool broke = limit.contains("first_unstable");
    if (kind == "units")
        ++units;
    else if (kind == "guard")
        ++guards;
    else
        ++limits, unbroken += broke ? 0 : 1;
    open_targets += limit.contains("asked") ? 1 : 0;
    below += limit.value("guarded", true) ? 0 : 1;
    doubted += text_at(limit, "doubt").empty() ? 0 : 1;
}

std::string Counts::verdict() const {
    const std::string guaranteed =
        below ? fmt::format("{} below the guaranteed range.", below) : std::string("Every guaranteed range passes.");
    return guaranteed +
           (open_targets ? fmt::format(" {} open {} beyond the guaranteed range {} not met.", open_targets,
                                       open_targets == 1 ? "target" : "targets", open_targets == 1 ? "is" : "are")
                         : "") +
           (doubted ? fmt::format(" {} contradict their description.", doubted) : "");
}

Map drawing_of_map(const json& m) {
    const auto texts = [](const json& list) {
        std::vector<std::string> words;
        for (const json& text : list) {
            words.push_back(text.get<std::string>());
            std::erase(words.back(), '"');  // as TOML writes words
        }
        return words;
    };
    const std::string method = text_at(m, "method");
    Map map{.title = text_at(m, "name") + (method.empty() ? "" : ", " + method),
            .x_label = text_at(m["x"], "label"),
            .y_label = text_at(m["y"], "label"),
            .x = texts(m["x"]["values"]),
            .y = texts(m["y"]["values"])};
    for (const json& column : m["cells"]) {
        map.cells.emplace_back();
        for (const json& c : column) {
            if (c.value("stable", true)) {
                map.cells.back().push_back({.text = "stable"});
                continue;
            }
            const std::string kind = text_at(c, "kind");
            auto at = std::find(map.kinds.begin(), map.kinds.end(), kind);
            if (at == map.kinds.end()) at = map.kinds.insert(at, kind);
            const auto step = c.value("step", std::int64_t{0});
            map.cells.back().push_back(
                {.stable = false, .kind = static_cast<int>(at - map.kinds.begin()), .text = fmt::format("{}", step)});
        }
    }
    return map;
}

std::string map_file(const json& study, const json& map) {
    const std::string method = text_at(map, "method");
    std::string name = text_at(study, "study") + "-" + text_at(map, "name") + (method.empty() ? "" : "-" + method);
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_'; }, '-');
    return name + ".svg";
}

Section limits_section(const std::vector<json>& studies, const std::filesystem::path& results) {
    if (studies.empty()) return {.summary = "<p>No limit is published: <code>./weir.sh stability --all --publish</code></p>", .html = ""};
    HtmlTable table({"solver", "parameter raised", "kind", "stable up to", "theory", "guaranteed", "first failure", "case"},
                    "Each key is raised until an invariant fails; the last value at which all invariants pass is the limit");
    Counts counts;
    std::set<std::string> machines;
    for (const json& study : studies) {
        add_rows(table, study);
        for (const json& l : study["limits"]) counts.add(l);
        machines.insert(fmt::format("{}: commit {}, {}", text_at(study, "study"), text_at(study, "commit"), text_at(study, "machine")));
    }
    Section section;
    section.summary = fmt::format(
        "<p class=\"big {}\">{} limits</p><p>measured by raising parameters until an invariant failed; {} never failed, for the reason "
        "given in the table. {} further axes check independence of units, {} check guards. {}</p>{}",
        counts.below + counts.doubted ? "no" : "pass", counts.limits, counts.unbroken, counts.units, counts.guards, counts.verdict(),
        beside_theory(studies));
    int maps = 0;
    for (const json& study : studies)
        if (study.contains("maps"))
            for (const json& map : study["maps"])
                section.html +=
                    fmt::format("<div>{}<p class=\"fine\">{}: difficulty: {}</p></div>\n",
                                published_plot(results / "stability" / "svg" / map_file(study, map), fmt::format("map{}", ++maps)),
                                escaped(text_at(study, "study")), escaped(text_at(map, "hard_because")));
    if (!section.html.empty()) section.html = "<h3>Two axes at once</h3><div class=\"maps\">" + section.html + "</div>";
    section.html += not_reached(studies) + "<h3>All limits</h3>" + table.html() + reasons(studies);
    std::string footer;
    for (const std::string& m : machines) footer += "<li>" + escaped(m) + "</li>";
    section.html += "<details class=\"fine\"><summary><code>./weir.sh stability --all</code></summary><ul>" + footer + "</ul></details>\n";
    return section;
}

}  // namespace weir::validation
