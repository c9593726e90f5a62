// The command line's job, without the command line.
#include "validation/report/command.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_lock.hpp"
#include "scene/names.hpp"
#include "validation/harness/runner.hpp"
#include "validation/page/page.hpp"
#include "validation/page/text.hpp"
#include "validation/report/figure.hpp"
#include "validation/report/publish.hpp"
#include "validation/report/published_case.hpp"
#include "validation/report/svg.hpp"
#include "validation/report/tables.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

#include <unistd.h>

namespace weir::validation {
namespace {

/// A folder named with a slash at its end has an empty last part.
std::filesystem::path without_slash(const std::filesystem::path& p) { return p.has_filename() ? p : p.parent_path(); }

/// A case may compare particles with a grid, which has no backend: its other scenes stay as they are.
void move_to_backend(Case& c, const ValidateOptions& options, const Solvers& solvers) {
    bool any = options.all;
    for (Variant& variant : c.variants) {
        if (!scene_of(variant, 0, scene::schemas_of(solvers)).has("scheme.backend")) continue;
        variant.overrides.push_back({"scheme.backend", '"' + options.backend + '"'});
        any = true;
    }
    if (!any)
        throw BadInput(fmt::format("--backend: no scene of the case {} has scheme.backend, which pbf and sph have", scene::quote(c.name)));
}

/// All case files and their scenes are read before one is run; the problems of all are shown together.
std::vector<Case> read_all(const ValidateOptions& options, const Solvers& solvers) {
    std::vector<Case> cases;
    std::string problems;
    const auto found = [] { return find_cases(case_root()); };
    for (const auto& folder : chosen_folders("validate", options.names, options.all, options.list, found)) try {
            cases.push_back(read_case(folder, options.size));
            if (!options.list && !options.backend.empty()) move_to_backend(cases.back(), options, solvers);
            if (options.steps > 0) cases.back() = cut_short(std::move(cases.back()), options.steps);
            if (!options.list) check_case(cases.back(), solvers);
        } catch (const BadInput& wrong) {
            problems += (problems.empty() ? "" : "\n") + std::string(wrong.what());
        }
    if (!problems.empty()) throw BadInput(problems);
    return cases;
}

/// Which sizes pins are of, and which scenes the published results.
void check_publishable(const ValidateOptions& options) {
    if (!options.publish.empty() && !options.backend.empty())
        throw BadInput("--publish runs the scenes unchanged, as the tests compare them: leave out --backend");
    if (options.compare.empty()) return;
    if (options.size != Size::ci) throw BadInput("--compare requires the ci size, whose values are published beside those of full size");
    if (options.steps > 0) throw BadInput("--compare runs every case to its end: leave out --steps");
    if (!options.backend.empty()) throw BadInput("--compare runs the scenes unchanged: leave out --backend");
}

/// Whether nothing that is published has moved.
bool is_as_published(const CaseResult& result, const ValidateOptions& options) {
    const Comparison c = compare_with_published(result, read_case(result.plan.folder, Size::full), options.compare);
    const std::string command = fmt::format("weir validate {} --size full --publish", result.plan.name);
    std::fputs(comparison_text(result.plan.name, command, c).c_str(), stderr);
    return c.moved.empty();
}

/// The numbers of the case at ci size: of `result` itself, or of runs anew.
Numbers ci_numbers(const CaseResult& result, const std::filesystem::path& out, const Solvers& solvers, const Progress& progress) {
    if (result.plan.size == Size::ci) return numbers_of(result);
    return numbers_of(validate(read_case(result.plan.folder, Size::ci), out / "ci", solvers, progress));
}

/// Whether its figure could be drawn too; the numbers stand without it.
bool write_outputs(const CaseResult& result, const std::filesystem::path& out) {
    output::write_file(out / "csv" / (result.plan.name + ".csv"), csv(result));
    try {
        draw(gnuplot_program(fmt::format("{} ({})", result.plan.name, name(result.plan.size)), panels_of(result)),
             out / "svg" / (result.plan.name + ".svg"));
        return true;
    } catch (const OutputError& failed) {
        std::fprintf(stderr, "%s\n", failed.what());
        return false;
    }
}

/// "couette: 4 runs, at most 3 steps each: not judged"
std::string cut_runs(const CaseResult& result) {
    std::size_t runs = 0;
    for (const auto& v : result.variants) runs += v.runs.size();
    return fmt::format("{}: {} runs of at most {} steps, no claim evaluated", result.plan.name, runs, *result.plan.cut);
}

/// The exit code of runs that are not judged: each must come to its end.
int ended(const std::vector<CaseResult>& results, int undrawn) {
    bool failed = false, bad = undrawn > 0;
    for (const CaseResult& result : results) {
        bad = bad || result.bad_input();
        for (const auto& v : result.variants)
            for (const RunResult& run : v.runs) failed = failed || run.failure;
    }
    return bad ? exit_bad_input : failed ? exit_claim_failed : exit_success;
}

int list_cases(const std::vector<Case>& cases) {
    for (const Case& c : cases) fmt::print("{:28} {:12} {}\n", c.name, name(c.kind), c.question);
    return exit_success;
}

}  // namespace

std::vector<std::filesystem::path> case_roots() {
    std::error_code unknown;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
    return {"cases", program.parent_path().parent_path() / WEIR_INSTALLED_CASES, WEIR_CASES_DIR};
}

std::filesystem::path case_root() {
    for (const auto& root : case_roots())
        if (std::filesystem::is_directory(root)) return root;
    return case_roots().back();
}

std::filesystem::path find_case_scene(const std::string& name) {
    std::vector<std::string> known, looked;
    for (const auto& root : case_roots()) {
        if (std::filesystem::exists(root / name / "scene.toml")) return root / name;
        looked.push_back(root.string());
        if (!std::filesystem::is_directory(root)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(root)) known.push_back(entry.path().filename().string());
    }
    throw BadInput(fmt::format("{}: there is no such file, and no such case{}\n    looked in {}", name, scene::did_you_mean(name, known),
                               fmt::join(looked, ", ")));
}

std::filesystem::path scene_named(const std::string& word) {
    const bool is_path = word.find_first_of("./") != std::string::npos;
    return is_path || std::filesystem::exists(word) ? std::filesystem::path(word) : find_case_scene(word);
}

std::filesystem::path published(const std::string& what) {
    for (const auto& root : case_roots())
        if (const auto folder = root.parent_path() / "results" / what; std::filesystem::is_directory(folder)) return folder;
    return std::filesystem::path("results") / what;
}

std::filesystem::path find_case(const std::string& name) {
    const auto holds_something = [](const std::filesystem::path& folder) {
        const auto holds = [&](const char* file) { return std::filesystem::exists(folder / file); };
        return holds("case.toml") || holds("cost.toml") || holds("stability.toml");
    };
    if (holds_something(name)) {
        const auto folder = without_slash(std::filesystem::path(name).lexically_normal());
        const bool has_name = folder.filename() != "." && folder.filename() != "..";  // the name of the case is that of its folder
        return has_name ? folder : std::filesystem::canonical(folder);
    }
    if (holds_something(case_root() / name)) return case_root() / name;
    std::vector<std::string> known;
    for (const auto& path : find_cases(case_root())) known.push_back(path.filename().string());
    throw BadInput(fmt::format("unknown case {}{}\n    {}", scene::quote(name), scene::did_you_mean(name, known), scene::known(known)));
}

std::vector<std::filesystem::path> chosen_folders(const std::string& command, const std::vector<std::string>& names, bool all, bool list,
                                                  const std::function<std::vector<std::filesystem::path>()>& find) {
    if (all && !names.empty()) throw BadInput(fmt::format("weir {}: give names of cases or --all, not both", command));
    if (all || (list && names.empty())) {
        const auto found = find();
        if (found.empty()) throw BadInput(fmt::format("weir {}: {} contains no case for it", command, case_root().string()));
        return found;
    }
    if (names.empty())
        throw BadInput(fmt::format("weir {} requires the name of a case or --all; --list prints the available cases", command));
    std::vector<std::filesystem::path> folders;
    for (const std::string& name : names) folders.push_back(find_case(name));
    return folders;
}

int validate_command(const ValidateOptions& options, const Solvers& solvers) {
    if (options.steps > 0 && !options.publish.empty())
        throw BadInput("--steps evaluates no claim, so there is nothing to publish: give --steps or --publish, not both");
    check_publishable(options);
    const std::vector<Case> cases = read_all(options, solvers);
    if (options.list) return list_cases(cases);
    output::require_writable(options.out);
    const output::FolderLock lock(options.out);
    std::filesystem::create_directories(options.out / "csv");
    const bool talk = !options.quiet && isatty(STDERR_FILENO);
    const Progress progress = [&](const std::string& what) {
        if (talk) std::fprintf(stderr, "\r\033[K%s", what.c_str());
    };
    std::vector<CaseResult> results;
    std::vector<nlohmann::json> pins;
    auto verdicts = nlohmann::json::array();
    bool passed = true, bad = false;
    int undrawn = 0;
    for (const Case& c : cases) {
        results.push_back(validate(c, options.out, solvers, progress));
        const CaseResult& result = results.back();
        if (talk) std::fprintf(stderr, "\r\033[K");
        fmt::print("{}\n", c.cut ? cut_runs(result) : claims_table(result) + orders_table(result));
        std::fflush(stdout);
        std::fputs(unreported_failures(result).c_str(), stderr);
        if (!options.compare.empty()) passed = is_as_published(result, options) && passed;
        if (!options.publish.empty()) pins.push_back(pins_json(ci_numbers(result, options.out, solvers, progress), result.seconds()));
        undrawn += write_outputs(result, options.out) ? 0 : 1;
        if (c.cut) continue;
        for (const auto& verdict : verdicts_json(result)) verdicts.push_back(verdict);
        output::write_file(options.out / "verdicts.json", verdicts.dump(1) + "\n");  // after each case: a killed run keeps what it has
        passed = passed && result.pass(), bad = bad || result.bad_input();
    }
    if (options.steps > 0) return ended(results, undrawn);
    if (!options.publish.empty()) publish(results, pins, options.out, options.publish);
    if (!options.publish.empty() && options.page) fmt::print("{}\n", write_page(options.publish).string());
    const auto claims = claimed(verdicts);
    std::size_t held = 0;
    for (const auto& verdict : claims) held += verdict["pass"].get<bool>() ? 1 : 0;
    fmt::print("{} of {} claims pass, in {} cases", held, claims.size(), results.size());
    if (const std::size_t open = verdicts.size() - claims.size(); open > 0) fmt::print("; {} open targets not met", open);
    fmt::print("\n");
    if (undrawn > 0) std::fprintf(stderr, "%d of %zu plots could not be drawn: exit code 2\n", undrawn, results.size());
    return bad || undrawn > 0 ? exit_bad_input : passed ? exit_success : exit_claim_failed;
}

}  // namespace weir::validation
