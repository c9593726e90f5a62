#include "validation/page/sections.hpp"

#include "validation/page/text.hpp"
#include "validation/page/thin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace weir::validation {
namespace {

using nlohmann::json;

constexpr double nearly = 0.9;  // of a bound: what the summary calls close to it

struct CaseClaims {
    std::string name{};
    std::vector<const json*> claims{};
    std::size_t held = 0, open_targets = 0;  // open_targets: bounds that are not met
    double seconds = 0;
    std::optional<double> nearest{};  // the largest part of a bound that one of its claims uses
    std::size_t count() const { return claims.size() - open_targets; }
    bool all_held() const { return held == count(); }
};

std::vector<CaseClaims> by_case(const json& verdicts) {
    std::map<std::string, CaseClaims> cases;
    for (const json& v : verdicts) {
        CaseClaims& c = cases[text_at(v, "case")];
        c.name = text_at(v, "case");
        c.claims.push_back(&v);
        if (!text_at(v, "not_reached").empty()) {
            ++c.open_targets;
            continue;
        }
        c.held += v.value("pass", false) ? 1 : 0;
        c.seconds += number_at(v, "seconds").value_or(0);
        if (const auto used = used_part(v)) c.nearest = std::max(c.nearest.value_or(0), *used);
    }
    std::vector<CaseClaims> list;
    for (auto& entry : cases) list.push_back(std::move(entry.second));
    return list;
}

std::string kind_text(const std::string& kind) {
    if (kind == "exact" || kind == "convergence") return "verification: " + kind;
    if (kind == "iterations") return "accuracy against work";
    return "validation: " + kind;
}

/// A bar that is full where a claim uses its whole bound.
HtmlTable::Cell bar(std::optional<double> part) {
    if (!part) return {.html = "exact", .key = 0, .number = true};
    const double percent = 100 * *part;
    return {.html = fmt::format("<span class=\"bar{}\" style=\"--part:{:.0f}%\"></span>{:.0f}%", *part > 1 ? " over" : "",
                                std::min(percent, 100.0), percent),
            .key = percent,
            .number = true};
}

HtmlTable::Cell verdict_cell(const json& v) {
    if (!text_at(v, "not_reached").empty()) return raw("open", 0.5);
    const bool pass = v.value("pass", false);
    return raw(pass ? "<b class=\"pass\">pass</b>" : "<b class=\"no\">FAIL</b>", pass ? 1 : 0);
}

std::string overview(const std::vector<CaseClaims>& cases) {
    HtmlTable table({"case", "question", "kind", "claims passed", "largest part of a bound used", "seconds"},
                    "All cases; each name links to the claims, their rationale and what is not covered");
    for (const CaseClaims& c : cases) {
        const json& first = *c.claims.front();
        const bool all = c.all_held();
        table.row({raw(fmt::format("<a href=\"#case-{0}\">{0}</a>", escaped(c.name))),
                   word(text_at(first, "question")),
                   word(kind_text(text_at(first, "kind"))),
                   {.html = fmt::format("<b class=\"{}\">{} of {}</b>", all ? "pass" : "no", c.held, c.count()),
                    .key = static_cast<double>(c.held) / static_cast<double>(std::max<std::size_t>(c.count(), 1)),
                    .number = true},
                   bar(c.nearest),
                   {.html = fmt::format("{:.1f}", c.seconds), .key = c.seconds, .number = true}},
                  all ? "" : "fail");
    }
    return table.html();
}

std::string links(const std::string& name, const std::filesystem::path& results) {
    std::string s;
    for (const auto& [path, what] : {std::pair{"csv/" + name + ".csv", "all values (CSV)"},
                                     {"svg/" + name + ".svg", "plot (SVG)"},
                                     {"../cases/" + name + "/case.toml", "claims as written"},
                                     {"../cases/" + name + "/README.md", "physics and source"}})
        if (std::filesystem::exists(results / path)) s += fmt::format(" · <a href=\"{}\">{}</a>", escaped(path), what);
    return s;
}

/// The measured value, with its band where the grids of a sweep give one.
HtmlTable::Cell measured_cell(const json& v) {
    HtmlTable::Cell cell = value(number_at(v, "measured"));
    if (const auto band = number_at(v, "band")) cell.html += fmt::format(" ± {:.2g}", *band);
    return cell;
}

std::string detail(const CaseClaims& c, const std::filesystem::path& results) {
    const json& first = *c.claims.front();
    const bool all = c.all_held();
    std::string s =
        fmt::format("<details id=\"case-{0}\" class=\"case\"{1}><summary><b>{0}</b> <span class=\"{2}\">{3} of {4}</span> {5}</summary>\n",
                    escaped(c.name), all ? "" : " open", all ? "pass" : "no", c.held, c.count(), escaped(text_at(first, "question")));
    s += fmt::format("<p><b>Not covered:</b> {}</p>\n", escaped(text_at(first, "blind_to")));
    if (!text_at(first, "source").empty()) s += fmt::format("<p><b>Compared with:</b> {}</p>\n", escaped(text_at(first, "source")));
    HtmlTable table({"verdict", "claim", "measured", "bound", "part of the bound used", "rationale", "seconds"}, "Claims of " + c.name);
    for (const json* v : c.claims) {
        std::string why = escaped(text_at(*v, "why"));
        const std::string short_of = text_at(*v, "not_reached");
        if (!short_of.empty()) why += " <b>Open target, not met:</b> " + escaped(short_of);
        if (const std::string note = text_at(*v, "note"); !note.empty()) why += " <b>" + escaped(note) + "</b>";
        const double seconds = number_at(*v, "seconds").value_or(0);
        table.row({verdict_cell(*v),
                   word(text_at(*v, "claim")),
                   measured_cell(*v),
                   raw("<span class=\"bound\">" + escaped(text_at(*v, "bound_text")) + "</span>"),
                   bar(used_part(*v)),
                   raw("<span class=\"why\">" + why + "</span>"),
                   {.html = fmt::format("{:.2f}", seconds), .key = seconds, .number = true}},
                  v->value("pass", false) || !short_of.empty() ? "" : "fail");
    }
    s += table.html() + published_plot(results / "svg" / (c.name + ".svg"), c.name);
    return s + fmt::format("<p class=\"fine\"><code>./weir.sh validate {0} --size {1}</code> · commit {2}{5}, {3}{4}</p></details>\n",
                           escaped(c.name), escaped(text_at(first, "size")), escaped(text_at(first, "commit")),
                           escaped(text_at(first, "machine")), links(c.name, results),
                           first.value("pinned", false) ? " (unchanged since)" : "");
}

/// "Verification: 120 of 120", one line a part of the suite.
std::string parts(const json& verdicts) {
    std::map<std::string, std::pair<std::size_t, std::size_t>> counts;
    for (const json& v : verdicts) {
        const std::string kind = kind_text(text_at(v, "kind"));
        auto& [held, all] = counts[kind.substr(0, kind.find(':'))];
        held += v.value("pass", false) ? 1 : 0, ++all;
    }
    std::string list;
    for (const auto& [kind, count] : counts) list += fmt::format("<li>{}: {} of {}</li>", kind, count.first, count.second);
    return "<ul>" + list + "</ul>";
}

/// Open targets with their values: a bound is never moved to where it passes.
std::string not_reached(const json& bounds) {
    if (bounds.empty()) return "";
    HtmlTable table({"case", "claim", "target", "measured", "rationale", "reason not met"}, "Open targets: bounds that are not met");
    for (const json& v : bounds)
        table.row({raw(fmt::format("<a href=\"#case-{0}\">{0}</a>", escaped(text_at(v, "case")))), word(text_at(v, "claim")),
                   raw("<span class=\"bound\">" + escaped(text_at(v, "bound_text")) + "</span>"), value(number_at(v, "measured")),
                   word(text_at(v, "why")), word(text_at(v, "not_reached"))});
    return "<h3 id=\"asked\">Open targets</h3>\n" + table.html();
}

std::string unpinned(const json& verdicts) {
    std::string list;
    for (const std::string& name : unpinned_cases(verdicts))
        list += fmt::format("{0}<a href=\"#case-{1}\">{1}</a>", list.empty() ? "" : ", ", escaped(name));
    return list.empty() ? "" : "<p><b>Not verified against the current code:</b> " + list + ".</p>\n";
}

std::string failures(const json& verdicts) {
    std::string list;
    for (const json& v : verdicts)
        if (!v.value("pass", false))
            list += fmt::format("<li><a href=\"#case-{0}\">{0}</a>: {1}</li>", escaped(text_at(v, "case")), escaped(text_at(v, "claim")));
    return list.empty() ? "" : "<ul class=\"failures\">" + list + "</ul>";
}

}  // namespace

std::optional<double> used_part(const json& v) {
    const auto measured = number_at(v, "measured");
    const auto bound = v.find("bound");
    if (!measured || bound == v.end()) return std::nullopt;
    if (bound->is_array() && bound->size() == 2 && (*bound)[0].is_number() && (*bound)[1].is_number()) {
        const double low = (*bound)[0], high = (*bound)[1];
        return high > low ? std::optional(std::abs(*measured - (low + high) / 2) / ((high - low) / 2)) : std::nullopt;
    }
    if (!bound->is_number() || bound->get<double>() <= 0) return std::nullopt;
    const double b = *bound;
    if (text_at(v, "bound_text").starts_with(">=")) return *measured > 0 ? std::optional(b / *measured) : std::nullopt;
    return std::max(0.0, *measured / b);
}

Section claims_section(const json& all_verdicts, const std::filesystem::path& results) {
    const auto cases = by_case(all_verdicts);
    const json verdicts = claimed(all_verdicts), open = open_targets(all_verdicts);
    std::size_t held = 0, close = 0;
    for (const json& v : verdicts) held += v.value("pass", false) ? 1 : 0, close += used_part(v).value_or(0) > nearly ? 1 : 0;
    const bool all = held == verdicts.size();
    Section section;
    section.summary = fmt::format(
        "<p class=\"big {}\">{} of {}</p><p>claims pass, in {} cases, each against an analytic or published reference. {} use more than "
        "{:.0f}% of their bound.{}</p>{}{}",
        all ? "pass" : "no", held, verdicts.size(), cases.size(), close, 100 * nearly,
        open.empty() ? "" : fmt::format(" <a href=\"#asked\">{} open targets are not met.</a>", open.size()), parts(verdicts),
        failures(verdicts));
    section.html =
        "<p>A claim is a measured value, a bound, and the rationale of that bound. Verification tests whether the equations are solved "
        "correctly, validation whether they are the right equations. Each case also states what it does not cover.</p>\n" +
        unpinned(all_verdicts) + overview(cases) + not_reached(open) +
        "<h3 id=\"cases\">All claims by case</h3>\n<p class=\"tools\"><label>Show claims that contain <input id=\"filter\" type=\"search\" "
        "placeholder=\"sph, divergence, order …\"></label> <button type=\"button\" id=\"unfold\">Open all cases</button></p>\n";
    for (const CaseClaims& c : cases) section.html += detail(c, results);
    return section;
}

}  // namespace weir::validation
