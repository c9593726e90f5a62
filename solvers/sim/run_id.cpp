#include "sim/run_id.hpp"

#include "sim/scene_files.hpp"
#include "sim/simulation.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <span>

namespace weir::sim {

namespace {

constexpr const char* block = "sim.run";

}  // namespace

std::string run_id(const scene::Scene& scene) {
    return fmt::format("{:016x}", digest(scene::to_json(scene.root()) + lines_of(scene_files(scene))));
}

std::string branch_id(const scene::Scene& scene, const std::string& continued, std::int64_t steps) {
    const std::string own = run_id(scene);
    return own == continued ? own : fmt::format("{:016x}", digest(fmt::format("{} of {} after {} steps", own, continued, steps)));
}

std::string scene_name(const scene::Scene& scene) {
    const auto is_name = [](const std::string& text) { return !text.empty() && text != "." && text != ".."; };  // of a folder of its own
    const std::filesystem::path path = std::filesystem::path(scene.file()).lexically_normal();
    const std::string stem = is_name(path.stem().string()) ? path.stem().string() : path.filename().string();
    std::string folder = path.parent_path().filename().string();
    if (folder == "..") folder = std::filesystem::absolute(path).lexically_normal().parent_path().filename().string();
    if (stem == "scene" && is_name(folder)) return folder;
    return is_name(stem) ? stem : "scene";
}

void put_run_id(Checkpoint& to, const std::string& run) { to.put(block, std::span<const char>(run)); }

std::string run_id_of(const Checkpoint& checkpoint) {
    if (!checkpoint.has(block)) return run_id(scene_of(checkpoint));
    std::vector<char> text;
    checkpoint.get(block, text);
    return {text.begin(), text.end()};
}

}  // namespace weir::sim
