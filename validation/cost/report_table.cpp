#include "validation/cost/report_table.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "output/machine.hpp"
#include "sim/loop.hpp"
#include "sim/simulation.hpp"
#include "validation/cost/load.hpp"
#include "validation/harness/variants.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace weir::validation {
namespace {

using nlohmann::json;
using scene::Key;
using scene::Type;

constexpr int warm_up_steps = 10, batches = 7, steps_a_batch = 20;

std::vector<Key> table_keys() {
    const auto text = [](std::string name, std::string doc) {
        return Key{.name = std::move(name), .type = Type::text, .doc = std::move(doc), .required = true};
    };
    std::vector<Key> row = variant_keys();
    for (Key k : {text("what", "The problem."), text("theirs", "The value as quoted in the report."),
                  Key{.name = "value", .type = Type::number, .doc = "The number in it.", .required = true, .min = 0, .min_open = true},
                  text("on", "CPU or GPU."),
                  Key{.name = "passes", .type = Type::texts, .doc = "Milliseconds of these passes; absent: frames per second."}})
        row.push_back(std::move(k));
    return {text("question", "Question of the table."),
            text("their_machine", "Machine of the report."),
            text("reading", "How the values are made comparable."),
            {.name = "rows", .type = Type::tables, .doc = "One entry per value.", .required = true, .keys = row}};
}

/// Milliseconds per step of the row's passes, or of everything.
double milliseconds(const ReportRow& row, Simulation& simulation) {
    auto& passes = simulation.solver().passes();
    passes.reset();
    const auto start = std::chrono::steady_clock::now();
    sim::advance(simulation, {.steps = steps_a_batch, .past_end = true});
    const double whole = 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / steps_a_batch;
    if (row.passes.empty()) return whole;
    double sum = 0;
    for (const std::string& name : row.passes) {
        const auto& list = passes.list();
        const auto at = std::find_if(list.begin(), list.end(), [&](const Pass& p) { return p.name == name; });
        if (at == list.end()) throw BadInput(fmt::format("{}: the solver has no pass \"{}\"", row.what, name));
        sum += 1e3 * at->seconds / steps_a_batch;
    }
    return sum;
}

json measure_row(const ReportRow& row, const Solvers& solvers, const Drawn& drawn) {
    const auto schemas = scene::schemas_of(solvers);
    const sim::NoThreadTrials no_trials;
    Simulation simulation(scene_of(row.variant, 0, schemas), solvers);
    sim::advance(simulation, {.steps = warm_up_steps, .past_end = true});
    const Work before = work_so_far();
    std::vector<double> ms;
    for (int i = 0; i < batches; ++i) ms.push_back(milliseconds(row, simulation));
    const double others = others_between(before, work_so_far());
    std::sort(ms.begin(), ms.end());
    const double median = ms[batches / 2], ours = row.passes.empty() ? 1000 / median : median;
    const double in_window = drawn && row.passes.empty() ? drawn(row.variant.scene, row.variant.overrides) : NAN;
    json measured = {{"what", row.what},
                     {"unit", row.unit()},
                     {"theirs", row.theirs},
                     {"their_value", row.value},
                     {"on", row.on},
                     {"ours", ours},
                     {"times", row.passes.empty() ? ours / row.value : row.value / ours},
                     {"spread", (ms.back() - ms.front()) / median},
                     {"others", others}};
    if (std::isfinite(in_window)) measured["drawn"] = in_window;
    return measured;
}

/// Frames a second in a window, where they were measured.
std::string drawn_text(const json& row) { return row.contains("drawn") ? fmt::format("{:.4g}", row["drawn"].get<double>()) : ""; }

std::string cell(const json& row, const char* key) { return row[key].get<std::string>(); }

}  // namespace

const std::vector<Key>& report_table_keys() {
    static const std::vector<Key> keys = table_keys();
    return keys;
}

ReportTable parse_report_table(std::string_view text, const std::string& file, const std::filesystem::path& folder) {
    const scene::Table root = scene::parse_table(text, file, report_table_keys());
    VariantReader reader(file, folder, Size::ci);
    ReportTable table{.question = reader.said(root, "question"),
                      .their_machine = reader.said(root, "their_machine"),
                      .reading = reader.said(root, "reading")};
    for (const scene::Table& t : root.tables("rows")) {
        ReportRow row{.what = reader.said(t, "what"),
                      .theirs = reader.said(t, "theirs"),
                      .value = t.number("value"),
                      .on = reader.said(t, "on"),
                      .variant = {.scene = folder / "scene.toml"}};
        if (t.has("passes")) row.passes = t.texts("passes");
        reader.lay_over(row.variant, t);
        table.rows.push_back(std::move(row));
    }
    if (!reader.problems().empty()) throw scene::BadScene(reader.problems(), text);
    return table;
}

ReportTable read_report_table(const std::filesystem::path& folder) {
    const auto file = folder / "table.toml";
    return parse_report_table(scene::read_text(file), file.string(), folder);
}

json measure_report_table(const ReportTable& table, const Solvers& solvers, const Drawn& drawn) {
    json rows = json::array();
    for (const ReportRow& row : table.rows) rows.push_back(measure_row(row, solvers, drawn));
    const output::Machine m = output::this_machine();
    return {{"question", table.question},
            {"their_machine", table.their_machine},
            {"reading", table.reading},
            {"rows", rows},
            {"threads", threads()},
            {"commit", m.commit},
            {"machine", fmt::format("{} ({} threads), {}, {}", m.processor, threads(), m.system, m.compiler)}};
}

std::string report_table_text(const json& table) {
    std::string s = fmt::format("{}\n    {:42} {:28} {:18} {:>10} {:9} {:>8} {:>8}\n", table["question"].get<std::string>(), "problem",
                                "the report", "on", "weir", "", "times", "drawn");
    for (const json& row : table["rows"])
        s += fmt::format("    {:42} {:28} {:18} {:>10.4g} {:9} {:>8.3g} {:>8}{}\n", cell(row, "what"), cell(row, "theirs"), cell(row, "on"),
                         row["ours"].get<double>(), cell(row, "unit"), row["times"].get<double>(), drawn_text(row),
                         row["others"].get<double>() > 0.2 ? fmt::format("  others used {:.1f} cores", row["others"].get<double>()) : "");
    return s;
}

std::string report_table_markdown(const json& table) {
    std::string s = fmt::format(
        "## {}\n\n{}\n\n| problem | the report | on | weir, {} CPU thread(s) | unit | times as fast | frames/s in a window "
        "|\n|---|---|---|---|---|---|---|\n",
        table["question"].get<std::string>(), table["reading"].get<std::string>(), table["threads"].get<int>());
    for (const json& row : table["rows"])
        s += fmt::format(
            "| {} | {} | {} | {:.4g} | {} | {:.3g}{} | {} |\n", cell(row, "what"), cell(row, "theirs"), cell(row, "on"),
            row["ours"].get<double>(), cell(row, "unit"), row["times"].get<double>(),
            row["others"].get<double>() > 0.2 ? fmt::format(" ({:.1f} cores busy with other work)", row["others"].get<double>()) : "",
            drawn_text(row));
    return s + fmt::format("\nThe report: {}. Weir: commit {}, on {}. `./weir.sh cost --report-table`\n\n",
                           table["their_machine"].get<std::string>(), table["commit"].get<std::string>(),
                           table["machine"].get<std::string>());
}

}  // namespace weir::validation
