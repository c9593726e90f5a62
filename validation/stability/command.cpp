#include "validation/stability/command.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/machine.hpp"
#include "scene/names.hpp"
#include "validation/report/command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include <unistd.h>

namespace weir::validation {
namespace {

using nlohmann::json;

/// The studies with the axes that are wanted; every scene at the low end of its axis reads.
std::vector<StressStudy> prepared(const StabilityOptions& options, const Solvers& solvers) {
    std::vector<scene::SolverSchema> schemas;
    for (const auto& kind : solvers) schemas.push_back(kind.schema);
    std::vector<StressStudy> studies;
    const auto found = [] { return find_stability(case_root()); };
    for (const auto& folder : chosen_folders("stability", options.names, options.all, options.list, found)) {
        studies.push_back(read_stability(folder, options.size));
        auto& stresses = studies.back().stresses;
        if (!options.axis.empty()) std::erase_if(stresses, [&](const Stress& s) { return s.name != options.axis; });
        if (options.floors) std::erase_if(stresses, [](const Stress& s) { return !s.floor; });
        for (const Stress& s : stresses) {
            Variant low = s.base;
            low.overrides.push_back({s.key, fmt::format("{:g}", s.low)});
            scene_of(low, 0, schemas);
        }
    }
    std::erase_if(studies, [](const StressStudy& s) { return s.stresses.empty(); });
    if (studies.empty())
        throw BadInput(options.axis.empty() ? "no axis has a floor" : fmt::format("no axis is called {}", scene::quote(options.axis)));
    return studies;
}

/// Writes the page anew, with the studies that were there before.
void publish_limits(const std::vector<json>& studies, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    for (const json& study : studies) output::write_file(folder / (study["study"].get<std::string>() + ".json"), study.dump(1) + "\n");
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::string page =
        "# Where it breaks\n\nThis page is written by `weir stability --publish`; nothing in it is typed by hand. Each key is "
        "raised until an invariant breaks; the last value at which none did is the limit.\n\n";
    for (const auto& file : files) {
        std::ifstream stream(file);
        if (const json study = json::parse(stream, nullptr, false); study.is_object()) page += limits_markdown(study);
    }
    output::write_file(folder / "index.md", page);
}

}  // namespace

int stability_command(const StabilityOptions& options, const Solvers& solvers) {
    const std::vector<StressStudy> studies = prepared(options, solvers);
    if (options.list) {
        for (const StressStudy& study : studies)
            for (const Stress& s : study.stresses) fmt::print("{:24} {:16} {:16} {}\n", study.name, s.name, s.method, s.hard_because);
        return exit_success;
    }
    output::require_writable(options.out);
    const bool talk = !options.quiet && isatty(STDERR_FILENO);
    const output::Machine machine = output::this_machine();
    std::vector<json> done;
    bool guarded = true;
    for (const StressStudy& study : studies) {
        std::vector<Limit> limits;
        for (const Stress& s : study.stresses) {
            if (talk) std::fprintf(stderr, "\r\033[K%s %s %s", study.name.c_str(), s.name.c_str(), s.method.c_str());
            limits.push_back(options.floors ? check_floor(s, solvers) : find_limit(s, bisection_factor(options.size), solvers));
            guarded = guarded && limits.back().guarded();
        }
        if (talk) std::fprintf(stderr, "\r\033[K");
        fmt::print("{}\n", limits_table(study, limits));
        std::fflush(stdout);
        done.push_back(limits_json(study, limits));
        done.back()["commit"] = machine.commit;
        done.back()["machine"] = fmt::format("{}, {}, {}", machine.processor, machine.system, machine.compiler);
        output::write_file(options.out / (study.name + ".json"), done.back().dump(1) + "\n");
    }
    if (!options.publish.empty()) publish_limits(done, options.publish);
    return guarded ? exit_success : exit_claim_failed;
}

}  // namespace weir::validation
