#include "validation/page/sections.hpp"

#include "validation/page/text.hpp"
#include "validation/page/thin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace weir::validation {
namespace {

using nlohmann::json;

bool failed(const json& point) { return point.contains("failure"); }
bool by_step(const json& study) { return text_at(study, "price") == "step"; }

/// Real-time factor, or milliseconds where a step is the price.
double abscissa(const json& study, const json& point) {
    if (by_step(study)) return number_at(point, "ms_per_step").value_or(0);
    const double seconds = number_at(point, "seconds_per_second").value_or(0);
    return seconds > 0 ? 1 / seconds : 0;
}

std::string table_of(const json& study) {
    std::vector<std::string> heads = {"setting", text_at(study, "error"), "× real time", "ms of a 60 Hz frame", "ms per step", "MB",
                                      "steps"};
    const auto also = study.value("also", std::vector<std::string>{});
    heads.insert(heads.end(), also.begin(), also.end());
    heads.push_back("on the Pareto front");
    HtmlTable table(heads, "All configurations of " + text_at(study, "study"));
    for (const json& p : study["points"]) {
        const auto bytes = number_at(p, "bytes");
        const bool broken = failed(p), front = p.value("front", false);
        const double seconds = number_at(p, "seconds_per_second").value_or(0);
        const auto if_run = [&](double v) { return value(broken ? std::nullopt : std::optional(v)); };
        std::vector<HtmlTable::Cell> cells = {word(text_at(p, "name")),
                                              broken ? raw(escaped(text_at(p, "failure"))) : value(number_at(p, "error")),
                                              value(seconds > 0 ? std::optional(1 / seconds) : std::nullopt),
                                              if_run(seconds * 1000 / 60),
                                              value(number_at(p, "ms_per_step")),
                                              value(bytes ? std::optional(*bytes / 1e6) : std::nullopt),
                                              value(number_at(p, "steps"))};
        const json measured = p.value("also", json::object());
        for (const std::string& metric : also) cells.push_back(value(number_at(measured, metric.c_str())));
        cells.push_back(raw(front ? "front" : "", front ? 0 : 1));
        table.row(std::move(cells), broken ? "fail" : front ? "front" : "");
    }
    return table.html();
}

std::string study_html(const json& study, const std::filesystem::path& results) {
    const std::string name = text_at(study, "study");
    std::string s = fmt::format(
        "<article id=\"cost-{}\"><h3>{}</h3>\n<div class=\"beside\">{}<ul "
        "class=\"advice\">",
        escaped(name), escaped(text_at(study, "question")), published_plot(results / "cost" / "svg" / (name + ".svg"), "cost-" + name));
    for (const json& sentence : study["advice"]) s += "<li>" + escaped(sentence.get<std::string>()) + "</li>";
    s += "</ul></div>\n";
    for (const json& note : study.value("notes", json::array())) s += "<p class=\"fine\">" + escaped(note.get<std::string>()) + "</p>\n";
    s += "<details><summary>All configurations</summary>" + table_of(study) + "</details>\n";
    s += fmt::format("<p class=\"fine\"><code>./weir.sh cost {0} --size {1}</code> · {2} thread(s), commit {3}, {4}", escaped(name),
                     escaped(text_at(study, "size")), study.value("threads", 1), escaped(text_at(study, "commit")),
                     escaped(text_at(study, "machine")));
    if (!study.contains("notes") && !text_at(study, "source").empty()) s += " · compared with " + escaped(text_at(study, "source"));
    if (const std::string csv = "cost/csv/" + name + ".csv"; std::filesystem::exists(results / csv))
        s += fmt::format(" · <a href=\"{}\">all values (CSV)</a>", escaped(csv));
    return s + "</p></article>\n";
}

/// The figures of the report that began this work beside ours.
std::string report_table(const json& t) {
    HtmlTable table({"problem", "the report", "on", "weir", "unit", "speedup", "frames/s in a window"},
                    "Threads of weir: " + std::to_string(t.value("threads", 1)));
    for (const json& row : t["rows"])
        table.row({word(text_at(row, "what")), raw(escaped(text_at(row, "theirs")), number_at(row, "their_value")),
                   word(text_at(row, "on")), value(number_at(row, "ours")), word(text_at(row, "unit")), value(number_at(row, "times")),
                   row.contains("drawn") ? value(number_at(row, "drawn")) : word("")});
    return fmt::format(
        "<article id=\"report-table\"><h3>{}</h3><p>An earlier report measured such methods in its own programs on one PC. Its values are "
        "quoted as published. They cannot be measured again, so compare only their order of magnitude with weir's.</p><p>{}</p>{}<p "
        "class=\"fine\"><code>./weir.sh cost --report-table</code> · the report: {} · weir: commit {}, {}</p></article>\n",
        escaped(text_at(t, "question")), escaped(text_at(t, "reading")), table.html(), escaped(text_at(t, "their_machine")),
        escaped(text_at(t, "commit")), escaped(text_at(t, "machine")));
}

/// The cells of a line of CSV that quotes nothing.
std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line)
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

/// What each effect adds to a step, from what `weir cost --effects --publish` wrote; empty where it has not.
std::string effects_table(const std::filesystem::path& results) {
    std::istringstream csv(bytes_of(results / "cost" / "effects.csv"));
    HtmlTable table({"solver", "dim", "effect", "a term of", "ms without", "ms with", "ratio of step times", "additional kB"},
                    "Steps with and without the effect, measured alternately; medians");
    std::map<std::string, std::size_t> column;
    std::size_t rows = 0;
    for (std::string line; std::getline(csv, line);) {
        if (line.empty() || line.front() == '#') continue;
        const auto cells = cells_of(line);
        if (column.empty()) {
            for (std::size_t i = 0; i < cells.size(); ++i) column[cells[i]] = i;
            continue;
        }
        const auto at = [&](const char* name) { return column.count(name) && column[name] < cells.size() ? cells[column[name]] : ""; };
        const auto number = [&](const char* name) { return std::atof(at(name).c_str()); };
        table.row({word(at("solver")), word(at("dim") + "D"), word(at("effect")), word(at("inside")), value(number("ms_without")),
                   value(number("ms_with")), value(number("ratio")), value((number("bytes_with") - number("bytes_without")) / 1e3)},
                  at("failure").empty() ? "" : "fail");
        ++rows;
    }
    if (rows == 0) return "";
    return "<article id=\"effects\"><h3>What does each effect cost?</h3><p>An effect that a scene does not name allocates no field and "
           "runs no pass.</p>" +
           table.html() +
           "<p class=\"fine\"><code>./weir.sh cost --effects</code> · <a href=\"cost/effects.csv\">all values (CSV)</a></p></article>\n";
}

/// Water methods side by side first, then the others by name: the more methods, the more a newcomer learns.
std::vector<const json*> in_reading_order(const std::vector<json>& studies) {
    std::vector<const json*> order;
    for (const json& s : studies) order.push_back(&s);
    std::stable_sort(order.begin(), order.end(), [](const json* a, const json* b) {
        return text_at(*a, "study").starts_with("dam_break") && !text_at(*b, "study").starts_with("dam_break");
    });
    return order;
}

}  // namespace

/// One curve a method through its settings, both in the order of the study, and the front.
Panel cost_panel(const json& study) {
    const std::string unit = text_at(study, "unit");
    Panel panel{
        .title = text_at(study, "question"),
        .x = {by_step(study) ? "computing time per step [ms]" : "real-time factor: simulated seconds per second of computing", true},
        .y = {text_at(study, "error") + (unit.empty() ? "" : " [" + unit + "]"), true}};
    Curve front{.label = "Pareto front: no configuration is both cheaper and more accurate", .dashed = true};
    std::vector<const json*> ordered;
    for (const json& p : study["points"]) {
        if (failed(p)) continue;
        ordered.push_back(&p);
        if (p.value("front", false))
            front.x.push_back(abscissa(study, p)), front.y.push_back(number_at(p, "error").value_or(0)),
                front.names.push_back(text_at(p, "name"));
    }
    std::stable_sort(ordered.begin(), ordered.end(), [](auto* p, auto* q) { return p->value("order", 0) < q->value("order", 0); });
    for (const json* p : ordered) {
        const std::string method = text_at(*p, p->contains("label") ? "label" : "method");
        auto at = std::find_if(panel.curves.begin(), panel.curves.end(), [&](const Curve& c) { return c.label == method; });
        if (at == panel.curves.end()) at = panel.curves.insert(at, Curve{.label = method});
        at->x.push_back(abscissa(study, *p)), at->y.push_back(number_at(*p, "error").value_or(0)), at->names.push_back(text_at(*p, "name"));
    }
    panel.curves.push_back(std::move(front));
    panel.shade = {number_at(study, "known_to").value_or(0), "below the uncertainty of the reference"};
    if (!by_step(study)) panel.marks = {{1, "real time"}};
    return panel;
}

Section cost_section(const std::vector<json>& studies, const std::filesystem::path& results) {
    Section section{.summary = "<p>No study is published: <code>./weir.sh cost --all --publish</code></p>"};
    const auto order = in_reading_order(studies);
    if (!order.empty()) {
        section.summary = fmt::format("<p class=\"asks\">{}</p><ul>", escaped(text_at(*order.front(), "question")));
        for (const json& sentence : (*order.front())["advice"]) section.summary += "<li>" + escaped(sentence.get<std::string>()) + "</li>";
        section.summary += fmt::format("</ul><p><a href=\"#cost-{}\">Plot and table</a></p>", escaped(text_at(*order.front(), "study")));
        section.html =
            "<p>The comparison is error against computing time: wall-clock time of all steps but the first, median of the repeats. Failed "
            "configurations stay in the tables.</p>\n";
    }
    for (const json* study : order) section.html += study_html(*study, results);
    if (const json table = json_of(results / "cost" / "report_table.json"); table.is_object()) section.html += report_table(table);
    section.html += effects_table(results);
    return section;
}

}  // namespace weir::validation
