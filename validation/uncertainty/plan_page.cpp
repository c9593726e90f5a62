// index.html of a plan: question, recommendation, figures, configurations, influences, methods. Texts of the scene are escaped.
#include "output/machine.hpp"
#include "validation/page/document.hpp"
#include "validation/page/text.hpp"
#include "validation/page/thin.hpp"
#include "validation/uncertainty/plan_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::validation {
namespace {

using namespace plan_words;
using Cell = HtmlTable::Cell;

/// Escaped, line by line.
std::string lines_of_html(std::string_view text) {
    std::string s;
    for (const char c : text) s += c == '\n' ? std::string("<br>") : escaped({&c, 1});
    return s;
}
std::string code(std::string_view text) { return "<code>" + escaped(text) + "</code>"; }
std::string item(std::string_view text) { return "<li>" + lines_of_html(text) + "</li>"; }
std::string list(const std::vector<std::string>& lines) {
    std::string s;
    for (const std::string& line : lines) s += item(line);
    return s.empty() ? s : "<ul class=\"advice\">" + s + "</ul>\n";
}
Cell note(std::string_view text) { return raw(lines_of_html(text)); }
Cell verdict(std::string_view text) { return raw("<span class=\"bound\">" + escaped(text) + "</span>"); }
/// A number with its unit; it sorts by `key`. "–" where the text is empty.
Cell number(const std::string& text, double key) {
    if (text.empty()) return {.html = "–", .number = true};
    return {.html = escaped(text), .key = key, .number = true};
}
std::string card(const char* id, const char* title, const std::string& html) {
    return fmt::format("<section class=\"card\" id=\"{}\"><h2>{}</h2>{}</section>\n", id, title, html);
}

std::string question_card(const ScenePlan& plan) {
    std::string s;
    for (std::size_t q = 0; q < plan.asked.size(); ++q)
        s += fmt::format("<p class=\"asks\">{}</p><p>{}</p>", escaped(plan.asked[q].quantity.text), escaped(wish_text(plan, q)));
    if (const std::string budget = budget_text(plan); !budget.empty()) s += "<p>" + escaped(budget) + "</p>";
    s += "<p>Scene: " + code(plan.file) + "</p>";
    for (const scene::Override& change : plan.set) s += "<p>Changed: " + code(change.key + " = " + change.value) + "</p>";
    return card("question", "Question", s + "<p>To ask again:<br>" + code(plan.command) + "</p>");
}

std::string refusal(const ScenePlan& plan) {
    std::vector<std::string> lines;
    for (const PlannedMethod& m : plan.methods)
        for (const QuantityStudy& q : m.study.quantities)
            if (!q.refused.empty()) lines.push_back(fmt::format("{}: {}: {}", m.study.method.name, q.asked.quantity.text, q.refused));
    for (const std::string& line : nearest(plan)) lines.push_back(line);
    return "<p class=\"big no\">None</p><p>No configuration of the ladder meets the request.</p>" + list(lines);
}

std::string recommendation_card(const ScenePlan& plan) {
    if (!plan.take) return card("recommendation", "Recommendation", refusal(plan));
    const MethodStudy& study = plan.methods[plan.take->method].study;
    const std::size_t g = plan.take->grid;
    std::string s = fmt::format("<p class=\"big pass\">{}, {} cells</p><ul>", escaped(study.method.name), study.grids[g].grid.text());
    for (const QuantityStudy& q : study.quantities)
        s += item(fmt::format("{} = {}, error at most {}", q.asked.quantity.text, value_text(q.values[g], q.error[g]),
                              text_with_unit(q.error[g], q.values[g].unit, q.error[g])));
    s += fmt::format("<li>{} of computing per frame of {}, on one thread</li></ul>", milliseconds(plan.take->seconds),
                     milliseconds(plan.limits.frame));
    return card("recommendation", "Recommendation", s + "<p>To run it:<br>" + code(run_line(plan, *plan.take)) + "</p>");
}

std::string time_card(const ScenePlan& plan) {
    std::string s = fmt::format("<p class=\"big\">{}</p><p>of computing for the runs that this question needed; other runs were kept.</p>",
                                plan.spent > 0 ? seconds_text(plan.spent) : "0 s");
    std::vector<std::string> lines;
    for (const PlannedMethod& m : plan.methods)
        if (!m.study.grids.empty()) lines.push_back(m.study.method.name + ": " + price_text(m.study));
    if (const std::string others = others_text(plan); !others.empty()) lines.push_back(others);
    return card("time", "Computing time", s + list(lines));
}

/// Failure, warnings, and per quantity why it is unknown or how the grids converge.
std::string notes_of(const MethodStudy& study, std::size_t g) {
    const RecordedRun& run = study.grids[g].run;
    if (run.failure) return *run.failure;
    std::vector<std::string> notes;
    for (const QuantityStudy& q : study.quantities)
        if (const std::string one = grid_note(q, study, g); !one.empty())
            notes.push_back(study.quantities.size() > 1 ? q.asked.quantity.text + ": " + one : one);
    notes.insert(notes.end(), run.warnings.begin(), run.warnings.end());
    return fmt::format("{}", fmt::join(notes, "\n"));
}

std::vector<Cell> grid_cells(const ScenePlan& plan, std::size_t m, std::size_t g) {
    const MethodStudy& study = plan.methods[m].study;
    double count = 1;
    for (const int along : study.grids[g].grid.cells) count *= along;
    std::vector<Cell> cells{word(study.method.name), number(study.grids[g].grid.text(), count)};
    for (const QuantityStudy& q : study.quantities) {
        const Value& value = q.values[g];
        const bool known = value.unknown.empty(), bounded = g < q.error.size();
        cells.push_back(known ? number(value_text(value, q.width), size_of(value.samples)) : number("", 0));
        cells.push_back(bounded ? number(text_with_unit(q.error[g], value.unit, q.error[g]), q.error[g]) : number("", 0));
    }
    const double seconds = study.seconds_per_frame(g, plan.limits.frame);
    cells.push_back(verdict(verdict_of(plan, m, g)));
    cells.push_back(number(in_milliseconds(seconds), seconds));
    cells.push_back(note(notes_of(study, g)));
    return cells;
}

std::string configurations(const ScenePlan& plan) {
    std::vector<std::string> heads{"method", "cells"};
    for (const Asked& asked : plan.asked) heads.push_back(asked.quantity.text), heads.push_back("error within");
    for (const char* head : {"verdict", "ms per frame", "note"}) heads.push_back(head);
    HtmlTable table(heads, fmt::format("All configurations. A frame is {} of simulated time; one thread", milliseconds(plan.limits.frame)));
    for (std::size_t m = 0; m < plan.methods.size(); ++m) {
        const MethodStudy& study = plan.methods[m].study;
        for (std::size_t g = 0; g < study.grids.size(); ++g) {
            const bool taken = plan.take && plan.take->method == m && plan.take->grid == g;
            table.row(grid_cells(plan, m, g), taken ? "front" : study.grids[g].run.failure ? "fail" : "");
        }
        if (study.solver_fails.empty()) continue;
        std::vector<Cell> cells{word(study.method.name), number("", 0)};
        while (cells.size() < heads.size() - 3) cells.push_back(number("", 0));
        cells.push_back(verdict("cannot run")), cells.push_back(number("", 0)),
            cells.push_back(note(study.solver_fails.substr(0, study.solver_fails.find('\n'))));
        table.row(std::move(cells), "fail");
    }
    std::vector<std::string> left_out;
    for (const PlannedMethod& m : plan.methods)
        if (!m.study.left_out.empty()) left_out.push_back(m.study.method.name + " left out: " + m.study.left_out);
    return "<p>\"Error within\" bounds the numerical error: the difference from the finest grid plus the band of the finest grid. It does "
           "not contain how well the equations describe an experiment.</p>\n" +
           table.html() + list(left_out);
}

std::string twin_text(const MethodStudy& study) {
    if (study.twin.empty()) return "";
    const std::string twin = fmt::format("{}: twin run with {}: the series ", study.method.name, study.twin);
    if (!study.chaotic_after) return twin + "differ by less than 5% of their range: not chaotic";
    return twin + fmt::format("differ by 5% of their range at t = {:.3g} s: chaotic from then on", *study.chaotic_after);
}

std::string influences(const ScenePlan& plan) {
    HtmlTable table({"method", "quantity", "band of the finest grid", "of the grids", "of the time step", "of the seeds", "observed order"},
                    "Parts of the band. –: no change, or not measured");
    std::vector<std::string> lines;
    for (const PlannedMethod& m : plan.methods) {
        for (const QuantityStudy& q : m.study.quantities) {
            const std::string& unit = q.finest().unit;
            const auto part = [&](real v) { return number(v > 0 ? text_with_unit(v, unit, q.width) : "", v); };
            table.row({word(m.study.method.name), word(q.asked.quantity.text), part(q.width), part(q.band ? q.band->width : 0),
                       part(q.finer * q.step), part(q.finer * q.seeds), q.band ? value(q.band->observed_order) : number("", 0)});
            for (const std::string& key : q.not_refined)
                lines.push_back(fmt::format("{}: {}: not refined: {}", m.study.method.name, q.asked.quantity.text, key));
        }
        if (const std::string twin = twin_text(m.study); !twin.empty()) lines.push_back(twin);
    }
    return "<p>Further runs on the coarsest grid halve the time step, place the markers at other random positions, and double keys that no "
           "grid refines. A twin run shows whether the flow is chaotic.</p>\n" +
           table.html() + list(lines);
}

std::string relation(const ScenePlan& plan, std::size_t m) {
    const PlannedMethod& planned = plan.methods[m];
    if (m == 0) return "the scene's own method";
    if (!planned.study.solver_fails.empty()) return "cannot run this scene: " + planned.study.solver_fails;
    const std::string compared = comparison_text(planned, plan);
    return compared.empty() ? "not compared: a series is unknown, or the flow is chaotic" : compared;
}

std::string methods(const ScenePlan& plan) {
    HtmlTable table({"method", "comparison with the scene's own", "refused", "limits of the model"}, "One row per method");
    for (std::size_t m = 0; m < plan.methods.size(); ++m) {
        const MethodStudy& study = plan.methods[m].study;
        std::vector<std::string> refused;
        for (const QuantityStudy& q : study.quantities)
            if (!q.refused.empty()) refused.push_back(q.asked.quantity.text + ": " + q.refused);
        table.row({word(study.method.name), note(relation(plan, m)), note(fmt::format("{}", fmt::join(refused, "\n"))),
                   word(left_out_by(study.method.solver))},
                  study.solver_fails.empty() ? "" : "fail");
    }
    const char* more = plan.methods.size() > 1 ? "" : "<p>One method was studied. <code>--with</code> compares it with others.</p>\n";
    return more + table.html();
}

std::string footer(const ScenePlan& plan) {
    const output::Machine m = output::this_machine();
    return fmt::format(
        "<footer><p>Made by weir {} (commit {}) on {}, {}, with {}. The same values: <a href=\"plan.json\">plan.json</a>.</p></footer>\n",
        escaped(m.version), escaped(m.commit), escaped(m.processor), escaped(m.system), code(plan.command));
}

}  // namespace

std::string plan_page(const ScenePlan& plan, const std::string& svg) {
    const std::string title = plan.title.empty() ? plan.name : plan.title;
    const std::string figures = svg.empty() ? "<p>gnuplot did not draw the figures.</p>\n" : plot_figure(svg, "plan");
    return document_html({.title = "weir plan: " + title,
                          .header = "<h1>" + escaped(title) + "</h1><p>A plan of weir: values with error bounds and computing time.</p>",
                          .cards = question_card(plan) + recommendation_card(plan) + time_card(plan),
                          .parts = {{"figures", "Figures", figures},
                                    {"configurations", "Configurations", configurations(plan)},
                                    {"influences", "Other influences", influences(plan)},
                                    {"methods", "Comparison of methods", methods(plan)}},
                          .footer = footer(plan)});
}

}  // namespace weir::validation
