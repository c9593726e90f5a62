#include "validation/stability/command.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_lock.hpp"
#include "output/machine.hpp"
#include "scene/names.hpp"
#include "validation/page/sections.hpp"
#include "validation/report/command.hpp"
#include "validation/report/publish.hpp"
#include "validation/report/study_plots.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

#include <unistd.h>

namespace weir::validation {
namespace {

using nlohmann::json;

/// The name of the solver that a configuration runs; throws where its scene does not read.
std::string solver_of(const Variant& variant, const Solvers& solvers) {
    const auto schemas = scene::schemas_of(solvers);
    return scene_of(variant, 0, schemas).solver();
}

/// Only the axes and maps that are wanted.
void choose(StressStudy& study, const StabilityOptions& options) {
    if (!options.axis.empty()) {
        std::erase_if(study.stresses, [&](const Stress& s) { return s.name != options.axis; });
        std::erase_if(study.maps, [&](const StressMap& m) { return m.stress.name != options.axis; });
    }
    if (!options.guaranteed_only) return;
    std::erase_if(study.stresses, [](const Stress& s) { return !s.guaranteed; });
    study.maps.clear();
    for (Stress& s : study.stresses)
        if (options.steps > 0) s.steps = std::min(s.steps, options.steps), s.cut = true;
}

/// The studies with the axes that are wanted; every scene at the low end of its axis reads, and so does the first of each map.
std::vector<StressStudy> prepared(const StabilityOptions& options, const Solvers& solvers) {
    std::vector<StressStudy> studies;
    const auto found = [] { return find_stability(case_root()); };
    for (const auto& folder : chosen_folders("stability", options.names, options.all, options.list, found)) {
        studies.push_back(read_stability(folder, options.size));
        StressStudy& study = studies.back();
        choose(study, options);
        for (Stress& s : study.stresses) s.solver = solver_of(pushed_to(s, s.low), solvers);
        for (StressMap& m : study.maps) {
            Variant first = m.stress.base;
            first.overrides.push_back({m.x.key, m.x.values.front()});
            first.overrides.push_back({m.y.key, m.y.values.front()});
            m.stress.solver = solver_of(first, solvers);
        }
    }
    std::erase_if(studies, [](const StressStudy& s) { return s.stresses.empty() && s.maps.empty(); });
    if (studies.empty())
        throw BadInput(options.axis.empty() ? "no axis has a floor" : fmt::format("no axis is called {}", scene::quote(options.axis)));
    return studies;
}

/// Writes the page anew, with the studies that were there before.
void publish_limits(const std::vector<json>& studies, const std::filesystem::path& out, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "svg");
    const auto lock = lock_published(folder, out);
    for (const json& study : studies) {
        output::write_file(folder / (study["study"].get<std::string>() + ".json"), study.dump(1) + "\n");
        draw_maps(study, folder / "svg");
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<json> all;
    for (const auto& file : files) {
        std::ifstream stream(file);
        if (json study = json::parse(stream, nullptr, false); study.is_object()) all.push_back(std::move(study));
    }
    std::string page =
        "# Stability limits\n\nThis page is written by `weir stability --publish`; no value is typed by hand. Each key is raised until an "
        "invariant fails; the last value at which all pass is the limit.\n\n" +
        open_targets_markdown(all) + all_limits_markdown(all);
    for (const json& study : all) page += limits_markdown(study);
    output::write_file(folder / "index.md", page);
}

}  // namespace

int stability_command(const StabilityOptions& options, const Solvers& solvers) {
    if (options.steps > 0 && (!options.guaranteed_only || !options.publish.empty()))
        throw BadInput("--steps evaluates no limit: give it together with --floors and without --publish");
    const std::vector<StressStudy> studies = prepared(options, solvers);
    if (options.list) {
        for (const StressStudy& study : studies)
            for (const Stress& s : study.stresses) fmt::print("{:24} {:16} {:16} {}\n", study.name, s.name, s.method, s.hard_because);
        return exit_success;
    }
    if (!options.compare.empty()) return compare_limits(studies, options.size, options.compare, solvers);
    output::require_writable(options.out);
    const output::FolderLock lock(options.out);
    const bool talk = !options.quiet && isatty(STDERR_FILENO);
    const output::Machine machine = output::this_machine();
    std::vector<json> done;
    bool sound = true;
    for (const StressStudy& study : studies) {
        const auto say = [&](const Stress& s, const std::string& more) {
            if (talk) std::fprintf(stderr, "\r\033[K%s %s %s%s", study.name.c_str(), s.name.c_str(), s.method.c_str(), more.c_str());
        };
        std::vector<Limit> limits;
        for (const Stress& s : study.stresses) {
            say(s, "");
            limits.push_back(options.guaranteed_only ? check_guaranteed(s, solvers)
                                                     : find_limit(s, bisection_factor(options.size), solvers));
            sound = sound && limits.back().passes();
        }
        done.push_back(limits_json(study, limits));
        for (const StressMap& m : study.maps) {
            const auto start = std::chrono::steady_clock::now();
            const auto cells = fill_map(m, solvers, [&](std::size_t i) { say(m.stress, fmt::format(" {}", i + 1)); });
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            done.back()["maps"].push_back(map_json(m, cells, seconds));
        }
        if (talk) std::fprintf(stderr, "\r\033[K");
        fmt::print("{}{}\n", limits_table(study, limits), maps_text(done.back()));
        std::fflush(stdout);
        done.back()["commit"] = machine.commit;
        done.back()["machine"] = fmt::format("{}, {}, {}", machine.processor, machine.system, machine.compiler);
        output::write_file(options.out / (study.name + ".json"), done.back().dump(1) + "\n");
        if (options.publish.empty()) continue;
        double seconds = 0;
        for (const Limit& l : limits) seconds += l.seconds;
        write_pins(pins_json(numbers_of(limits), seconds), options.publish, study.name);
    }
    if (!options.publish.empty()) publish_limits(done, options.out, options.publish);
    return sound || options.steps > 0 ? exit_success : exit_claim_failed;
}

}  // namespace weir::validation
