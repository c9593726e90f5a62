#include "validation/cost/command.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_lock.hpp"
#include "output/machine.hpp"
#include "scene/names.hpp"
#include "validation/cost/report_table.hpp"
#include "validation/cost/tables.hpp"
#include "validation/page/sections.hpp"
#include "validation/page/text.hpp"
#include "validation/report/command.hpp"
#include "validation/report/pins.hpp"
#include "validation/report/publish.hpp"
#include "validation/report/study_plots.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include <unistd.h>

namespace weir::validation {
namespace {

using nlohmann::json;

/// The study with the command's changes; every scene in it reads.
Study prepared(const std::filesystem::path& folder, const CostOptions& options, const Solvers& solvers) {
    Study study = read_study(folder, options.size);
    if (!options.error.empty()) study.error = options.error;
    const auto schemas = scene::schemas_of(solvers);
    if (!options.solver.empty())
        std::erase_if(study.methods, [&](const Variant& v) { return scene_of(v, 0, schemas).solver() != options.solver; });
    if (study.methods.empty()) throw BadInput(fmt::format("{}: no method uses solver {}", study.name, scene::quote(options.solver)));
    if (!options.vary.empty()) vary(study, options.vary, solvers);
    for (const Variant& v : study.methods)
        for (std::size_t i = 0; i < v.runs(); ++i) make_reference(v.reference, scene_of(v, i, schemas), study.folder);
    return study;
}

void write_outputs(const StudyResult& result, const json& study, const std::filesystem::path& out) {
    const std::string& name = result.study.name;
    output::write_file(out / (name + ".csv"), cost_csv(result));
    output::write_file(out / (name + ".json"), study.dump(1) + "\n");
    draw_cost(study, out / (name + ".svg"));
}

/// Errors and bytes at ci size: each setting runs once, on one thread, which bytes depend on.
Numbers ci_numbers(const Study& study, CostOptions options, const Solvers& solvers) {
    options.size = Size::ci, options.measure.repeats = 1;
    Study small = prepared(study.folder, options, solvers);
    for (Variant& method : small.methods) method.threads = 1;
    return numbers_of(measure_study(small, options.measure, solvers));
}

/// Whether errors and bytes are those that the published tables began with.
int compare_studies(const std::vector<Study>& studies, const CostOptions& options, const Solvers& solvers) {
    bool same = true;
    for (const Study& study : studies) {
        const json pins = json_of(pins_file(options.compare, study.name));
        const Comparison c = compare_numbers(pins.is_object() ? ci_numbers(study, options, solvers) : Numbers{}, pins);
        const std::string command = fmt::format("weir cost {} --size full --publish", study.name);
        std::fputs(comparison_text(study.name + ", cost", command, c).c_str(), stderr);
        same = same && c.moved.empty();
    }
    fmt::print("{} of {} studies compared with {}\n", same ? "all" : "not all", studies.size(), options.compare.string());
    return same ? exit_success : exit_claim_failed;
}

json read_json(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return json::parse(stream, nullptr, false);
}

/// Copies what was written into the published folder and writes its page anew, with the studies that were there before.
void publish_studies(const std::vector<json>& studies, const std::filesystem::path& out, const std::filesystem::path& folder) {
    for (const auto* kind : {"csv", "svg", "json"}) std::filesystem::create_directories(folder / kind);
    const auto lock = lock_published(folder, out);
    for (const json& study : studies)
        for (const auto* kind : {"csv", "svg", "json"}) {
            const std::string name = study["study"].get<std::string>() + "." + kind;
            if (std::filesystem::exists(out / name))
                std::filesystem::copy_file(out / name, folder / kind / name, std::filesystem::copy_options::overwrite_existing);
        }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "json")) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::string page =
        "# Cost of accuracy\n\nThis page is written by `weir cost --publish`; no value is typed by hand. Computing time is wall-clock time "
        "of all steps but the first, the median of the repeats.\n\n";
    if (std::filesystem::exists(folder / "effects.md")) page += "Cost of each effect of each solver: [effects.md](effects.md).\n\n";
    for (const auto& file : files)
        if (const json study = read_json(file); study.is_object()) page += cost_markdown(study);
    if (const json table = read_json(folder / "report_table.json"); table.is_object()) page += report_table_markdown(table);
    output::write_file(folder / "index.md", page);
}

int report_table_command(const CostOptions& options, const Solvers& solvers) {
    if (options.all || !options.names.empty()) throw BadInput("weir cost --report-table: leave out names and --all");
    const ReportTable table = read_report_table(case_root() / "report_table");
    output::require_writable(options.out);
    const output::FolderLock lock(options.out);
    const json measured = measure_report_table(table, solvers, options.drawn);
    fmt::print("{}", report_table_text(measured));
    output::write_file(options.out / "report_table.json", measured.dump(1) + "\n");
    if (options.publish.empty()) return exit_success;
    std::filesystem::create_directories(options.publish);
    output::write_file(options.publish / "report_table.json", measured.dump(1) + "\n");
    publish_studies({}, options.out, options.publish);
    return exit_success;
}

}  // namespace

int cost_command(const CostOptions& options, const Solvers& solvers) {
    if (options.report_table) return report_table_command(options, solvers);
    std::vector<Study> studies;
    std::string problems;
    const auto found = [] { return find_studies(case_root()); };
    for (const auto& folder : chosen_folders("cost", options.names, options.all, options.list, found)) try {
            studies.push_back(prepared(folder, options, solvers));
        } catch (const BadInput& wrong) {
            problems += (problems.empty() ? "" : "\n") + std::string(wrong.what());
        }
    if (!problems.empty()) throw BadInput(problems);
    if (options.list) {
        for (const Study& s : studies) fmt::print("{:28} {}\n", s.name, s.question);
        return exit_success;
    }
    if (!options.compare.empty()) return compare_studies(studies, options, solvers);
    output::require_writable(options.out);
    const output::FolderLock lock(options.out);
    const bool talk = !options.quiet && isatty(STDERR_FILENO);
    const output::Machine machine = output::this_machine();
    std::vector<json> done;
    bool all_failed = false;
    for (const Study& study : studies) {
        const StudyResult result = measure_study(study, options.measure, solvers, [&](const std::string& what) {
            if (talk) std::fprintf(stderr, "\r\033[K%s", what.c_str());
        });
        if (talk) std::fprintf(stderr, "\r\033[K");
        fmt::print("{}\n", cost_table(result));
        std::fflush(stdout);
        done.push_back(cost_json(result));
        done.back()["commit"] = machine.commit;
        done.back()["machine"] =
            fmt::format("{} ({} threads), {}, {}", machine.processor, result.threads, machine.system, machine.compiler);
        write_outputs(result, done.back(), options.out);
        if (!options.publish.empty()) {
            double seconds = 0;
            for (const CostPoint& p : result.points) seconds += p.repeats * p.ms_per_step * 1e-3 * static_cast<double>(p.steps);
            write_pins(pins_json(ci_numbers(study, options, solvers), seconds), options.publish, study.name);
        }
        all_failed |= std::all_of(result.points.begin(), result.points.end(), [](const CostPoint& p) { return p.failure.has_value(); });
    }
    if (!options.publish.empty()) publish_studies(done, options.out, options.publish);
    return all_failed ? exit_claim_failed : exit_success;
}

}  // namespace weir::validation
