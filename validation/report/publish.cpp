// One row a claim: measured, bound, why, seconds, figure, frames. No number here was typed by hand.
#include "validation/report/publish.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/machine.hpp"
#include "validation/page/text.hpp"
#include "validation/report/published_case.hpp"
#include "validation/report/tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <set>

namespace weir::validation {
namespace {

using nlohmann::json;

std::string text(const json& entry, const char* key) { return entry.value(key, std::string()); }

/// A cell of a Markdown table may hold no bar and no line break.
std::string cell(std::string s) {
    for (std::size_t at = 0; (at = s.find_first_of("|\n", at)) != std::string::npos; ++at)
        s.replace(at, 1, s[at] == '|' ? "\\|" : " "), ++at;
    return s;
}

std::string number(const json& entry, const char* key, const char* form) {
    const auto at = entry.find(key);
    return at == entry.end() || !at->is_number() ? "not a number" : fmt::format(fmt::runtime(form), at->get<double>());
}

/// "2.648", with its band where the grids of a sweep give one: "2.648 ± 0.014".
std::string measured_text(const json& v) {
    const auto band = v.find("band");
    const bool known = band != v.end() && band->is_number();
    return number(v, "measured", "{:.4g}") + (known ? fmt::format(" ± {:.2g}", band->get<double>()) : "");
}

std::string row(const json& v) {
    const std::string name = text(v, "case");
    std::string why = text(v, "why");
    const bool is_open_target = !text(v, "not_reached").empty();
    if (is_open_target) why += " **Open target, not met:** " + text(v, "not_reached");
    if (!text(v, "note").empty()) why += " **" + text(v, "note") + "**";
    return fmt::format("| {} | {} | {} | {} | {} | {} | [svg](svg/{}.svg) | `{}` |\n",
                       is_open_target           ? "open"
                       : v.value("pass", false) ? "pass"
                                                : "**FAIL**",
                       cell(text(v, "claim")), measured_text(v), cell(text(v, "bound_text")), cell(why), number(v, "seconds", "{:.2f}"),
                       name, cell(text(v, "frames")));
}

std::string section(const std::vector<const json*>& claims) {
    const json& first = *claims.front();
    const std::string name = text(first, "case");
    std::string s = fmt::format("### {}\n\n{}\n\n*Not covered:* {}\n\n", name, text(first, "question"), text(first, "blind_to"));
    if (!text(first, "source").empty()) s += fmt::format("*Compared with:* {}\n\n", text(first, "source"));
    s += "| | claim | measured | bound | rationale | seconds | plot | frames |\n|---|---|---|---|---|---|---|---|\n";
    for (const json* v : claims) s += row(*v);
    s += fmt::format(
        "\n![{0}](svg/{0}.svg)\n\nAll values: [csv/{0}.csv](csv/{0}.csv). Measured at size {1}, commit {2}{4}, on {3}: `./weir.sh validate "
        "{0} --size {1}`\n\n",
        name, text(first, "size"), text(first, "commit"), text(first, "machine"), first.value("pinned", false) ? " (unchanged since)" : "");
    return s;
}

/// Open targets come first, each with its value.
std::string not_reached_table(const json& bounds) {
    if (bounds.empty()) return "";
    std::string s = "## Open targets\n\n| case | claim | target | measured | rationale | reason not met |\n|---|---|---|---|---|---|\n";
    for (const json& v : bounds)
        s += fmt::format("| {0} | {1} | {2} | {3} | {4} | {5} |\n", text(v, "case"), cell(text(v, "claim")), cell(text(v, "bound_text")),
                         number(v, "measured", "{:.4g}"), cell(text(v, "why")), cell(text(v, "not_reached")));
    return s + "\n";
}

std::string machine_text(const output::Machine& m) {
    return fmt::format("{} ({} threads), {}, {}, {}", m.processor, m.threads, m.system, m.compiler, m.build);
}

json read_entries(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) return json::array();
    json entries = json::parse(stream, nullptr, false);
    if (!entries.is_array()) throw BadInput(file.string() + " is not a list of verdicts; remove it and publish all cases");
    return entries;
}

void copy_over(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::filesystem::create_directories(to.parent_path());
    std::error_code error;
    std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing, error);
    if (error) throw OutputError(fmt::format("cannot copy {} to {}: {}", from.string(), to.string(), error.message()));
}

}  // namespace

std::string index_markdown(const json& verdicts) {
    std::map<std::string, std::vector<const json*>> by_case;
    std::size_t passed = 0;
    for (const json& v : verdicts) by_case[text(v, "case")].push_back(&v);
    const json claims = claimed(verdicts);
    for (const json& v : claims) passed += v.value("pass", false) ? 1 : 0;
    std::string s = "# Results\n\nThis page is written by `weir validate --publish`; nothing in it is typed by hand.\n\n";
    s += fmt::format("**{} of {} claims pass, in {} cases.**\n\n", passed, claims.size(), by_case.size());
    s +=
        "The tests run every case at its small size and compare its values with those published with this page: a changed value fails.\n\n";
    if (const auto unpinned = unpinned_cases(verdicts); !unpinned.empty())
        s += fmt::format("Not verified against the current code: {}.\n\n", fmt::join(unpinned, ", "));
    s += not_reached_table(open_targets(verdicts));
    const std::pair<const char*, std::set<std::string>> parts[] = {
        {"Verification: are the equations solved right?", {"exact", "convergence"}},
        {"Accuracy against solver work", {"iterations"}},
        {"Validation: are they the right equations?", {"benchmark"}},
    };
    for (const auto& [title, kinds] : parts) {
        std::string sections;
        for (const auto& entry : by_case)
            if (kinds.count(text(*entry.second.front(), "kind"))) sections += section(entry.second);
        if (!sections.empty()) s += fmt::format("## {}\n\n{}", title, sections);
    }
    const output::Machine m = output::this_machine();
    return s + fmt::format("---\nWritten by weir {} (commit {}) on {}.\n", m.version, m.commit, machine_text(m));
}

std::unique_ptr<output::FolderLock> lock_published(const std::filesystem::path& folder, const std::filesystem::path& out) {
    if (std::filesystem::exists(out) && std::filesystem::equivalent(folder, out)) return nullptr;
    return std::make_unique<output::FolderLock>(folder, output::FolderLock::IfTaken::wait);
}

void publish(const std::vector<CaseResult>& results, const std::vector<json>& pins, const std::filesystem::path& out,
             const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const auto lock = lock_published(folder, out);
    const output::Machine machine = output::this_machine();
    std::set<std::string> measured;
    json entries = json::array();
    for (const CaseResult& result : results) {
        const std::string& name = result.plan.name;
        measured.insert(name);
        for (json entry : verdicts_json(result)) {
            entry["commit"] = machine.commit, entry["machine"] = machine_text(machine), entry["pinned"] = true;
            entries.push_back(entry);
        }
        if (std::filesystem::exists(out / "svg" / (name + ".svg")))
            copy_over(out / "svg" / (name + ".svg"), folder / "svg" / (name + ".svg"));
        copy_over(out / "csv" / (name + ".csv"), folder / "csv" / (name + ".csv"));
    }
    for (json old : read_entries(folder / "verdicts.json"))
        if (!measured.count(text(old, "case"))) {
            old.erase("older");
            entries.push_back(old);
        }
    for (std::size_t i = 0; i < results.size(); ++i) write_pins(pins.at(i), folder, results[i].plan.name);
    output::write_file(folder / "verdicts.json", entries.dump(1) + "\n");
    write_index(folder);
}

void write_index(const std::filesystem::path& folder) {
    output::write_file(folder / "index.md", index_markdown(read_entries(folder / "verdicts.json")));
}

}  // namespace weir::validation
