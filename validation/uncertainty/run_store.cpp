#include "validation/uncertainty/run_store.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/machine.hpp"
#include "sim/scene_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include <dlfcn.h>

namespace weir::validation {
namespace {

/// When the program was built: the executable, or the module of Python that holds this function.
std::int64_t time_of_program() {
    Dl_info info{};
    const bool module = dladdr(reinterpret_cast<const void*>(&time_of_program), &info) != 0 && info.dli_fname &&
                        std::string_view(info.dli_fname).find(".so") != std::string_view::npos;
    std::error_code none;
    return std::filesystem::last_write_time(module ? info.dli_fname : "/proc/self/exe", none).time_since_epoch().count();
}

/// What a run depends on: the program, the whole scene, not how it is written, and its files. Output changes no result, unless steps are
/// shortened to meet frames.
std::string key_of(const scene::Scene& scene) {
    scene::Table root = scene.root();
    root.erase("title");
    const bool meets_frames = scene.has("output.at") && scene.text("output.at") == "exact";
    if (!meets_frames) root.erase("output");
    const output::Machine machine = output::this_machine();
    const std::string text = scene::to_toml(root);
    return fmt::format("{} {} {} {}\n{}{}", machine.version, machine.commit, machine.rounding, time_of_program(), text,
                       sim::lines_of(sim::scene_files(scene)));
}

/// A kept run: a line with the checksum of its scene and of its text, then the text.
std::string checksum_line(const std::string& key, const std::string& text) { return fmt::format("{:016x}\n", sim::digest(key + text)); }

/// The run in this file. Throws BadInput where it is damaged, or of another scene.
RecordedRun kept_run(std::istream& file, const std::string& key) {
    const std::string all{std::istreambuf_iterator<char>(file), {}};
    const std::string text = all.substr(std::min(all.size(), all.find('\n') + 1));
    if (all != checksum_line(key, text) + text) throw BadInput("a kept run is damaged");
    return run_from_json(text);
}

bool has_metrics(const RecordedRun& run, const std::vector<std::string>& metrics) {
    for (const auto& name : metrics)
        if (run.measured.count(name) == 0 && !run.failure) return false;
    return true;
}

}  // namespace

RunStore::RunStore(std::filesystem::path folder, std::vector<std::string> metrics, double time_limit, const Solvers& solvers)
    : folder_(std::move(folder)), metrics_(std::move(metrics)), time_limit_(time_limit), solvers_(&solvers) {}

std::filesystem::path RunStore::file_of(const std::string& key) const { return folder_ / fmt::format("{:016x}.run", sim::digest(key)); }

const RecordedRun& RunStore::run(const scene::Scene& scene) {
    const std::string key = key_of(scene);
    if (const auto known = runs_.find(key); known != runs_.end()) return known->second;
    std::error_code none;
    const bool kept_there = !folder_.empty() && std::filesystem::is_regular_file(std::filesystem::symlink_status(file_of(key), none));
    if (kept_there) try {
            std::ifstream file(file_of(key));
            RecordedRun kept = kept_run(file, key);
            if (has_metrics(kept, metrics_)) return runs_[key] = std::move(kept);
        } catch (const BadInput&) {  // damaged, or of another version: made again
        }
    RecordedRun& made = runs_[key] = record_run(scene, metrics_, time_limit_, *solvers_);
    seconds_ += made.seconds;
    const bool out_of_time = made.failure && made.seconds > time_limit_;
    const bool taken = std::filesystem::exists(std::filesystem::symlink_status(file_of(key), none)) && !kept_there;  // not ours
    if (folder_.empty() || out_of_time || taken) return made;
    const std::string text = to_json(made);
    output::write_file(file_of(key), checksum_line(key, text) + text);
    return made;
}

}  // namespace weir::validation
