#include "app/owner.hpp"

#include "core/error.hpp"
#include "core/words.hpp"
#include "output/atomic_file.hpp"
#include "parallel/communicator.hpp"
#include "sim/loop.hpp"
#include "sim/run_id.hpp"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace weir::app {

namespace {

constexpr const char* unfinished_ending = ".part";  // of checkpoints and of output/atomic_file.cpp

/// The id in run.json; empty where there is none, as in folders of weir before it had ids.
std::string run_in(const std::filesystem::path& folder) {
    nlohmann::json j;
    try {
        j = nlohmann::json::parse(bytes_of(folder / "run.json"), nullptr, false);
    } catch (const BadInput&) {
        return "";
    }
    return j.is_object() && j.contains("run") && j["run"].is_string() ? j["run"].get<std::string>() : "";
}

void move_away(const std::filesystem::path& checkpoint, bool quiet) {
    if (!std::filesystem::exists(checkpoint)) return;
    std::error_code failed;
    std::filesystem::rename(checkpoint, earlier(checkpoint), failed);
    if (failed) throw OutputError("cannot rename " + checkpoint.string() + ": " + failed.message());
    if (!quiet)
        std::fprintf(stderr, "%s belongs to an earlier run: renamed to %s\n", checkpoint.c_str(), earlier(checkpoint).filename().c_str());
}

/// Files that a killed run was writing when it ended. The folder is locked, so no run is writing them now.
void remove_unfinished(const std::filesystem::path& folder) {
    std::error_code ignored;
    const auto remove = [&](const std::filesystem::path& file) { std::filesystem::remove(file, ignored); };
    for (const auto& file : {sim::checkpoint_file(folder), sim::last_good_file(folder), folder / "run.json"})
        remove(file.string() + unfinished_ending);
    for (const auto& entry : std::filesystem::directory_iterator(folder / "frames", ignored))
        if (entry.path().extension() == unfinished_ending && !entry.is_directory(ignored)) remove(entry.path());
}

}  // namespace

std::unique_ptr<output::FolderLock> lock_folder(const std::filesystem::path& folder) {
    std::unique_ptr<output::FolderLock> lock;
    by_first_rank([&] {
        output::require_writable(folder);
        lock = std::make_unique<output::FolderLock>(folder);
        if (!lock->unlocked().empty())
            std::fprintf(stderr, "%s: the file system has no locks (%s): do not start a second run into this folder\n", folder.c_str(),
                         lock->unlocked().c_str());
    });
    return lock;
}

std::filesystem::path earlier(const std::filesystem::path& checkpoint) {
    return checkpoint.parent_path() / ("earlier_" + checkpoint.filename().string());
}

bool holds_run(const std::filesystem::path& folder, const std::string& run) { return !run.empty() && run_in(folder) == run; }

std::string own_as_new(const std::filesystem::path& folder, const scene::Scene& scene, bool quiet) {
    by_first_rank([&] {
        for (const auto& checkpoint : {sim::checkpoint_file(folder), sim::last_good_file(folder)}) move_away(checkpoint, quiet);
        remove_unfinished(folder);
    });
    return sim::run_id(scene);
}

std::string own_as_continued(const std::filesystem::path& folder, const scene::Scene& scene, const std::string& continued,
                             std::int64_t steps) {
    const std::string branch = sim::branch_id(scene, continued, steps);
    bool holds_continued = false;
    by_first_rank([&] {
        const std::string there = run_in(folder);
        holds_continued = std::filesystem::exists(folder / "run.json") && there != branch;
        if (!there.empty() && there != continued && there != branch)
            throw BadInput(folder.string() + ": the files in this folder belong to run " + there + ", but the checkpoint belongs to run " +
                           continued + ": continue in the folder of its own run, or in a new one (--out)");
        remove_unfinished(folder);
    });
    return communicator().largest(holds_continued ? 1 : 0) != 0 ? continued : branch;
}

}  // namespace weir::app
