#include "app/run_folder.hpp"

#include "core/error.hpp"
#include "sim/registry.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

namespace weir::app {

scene::Scene scene_of_run(const std::filesystem::path& folder) {
    std::ifstream file(folder / "run.json");
    const auto j = nlohmann::json::parse(file, nullptr, false);
    if (!j.is_object() || !j.contains("scene"))
        throw BadInput(folder.string() + " is not the folder of a run: it has no readable run.json");
    std::vector<scene::Override> overrides;
    for (const auto& text : j["scene"]["overrides"]) overrides.push_back(scene::to_override(text.get<std::string>()));
    return scene::parse(j["scene"]["source"].get<std::string>(), j["scene"]["file"].get<std::string>(), sim::schemas(), overrides);
}

std::string scene_name(const scene::Scene& scene) {
    const std::filesystem::path path = std::filesystem::path(scene.file()).lexically_normal();
    const std::string stem = path.stem().string();
    const std::string folder = path.parent_path().filename().string();
    return stem == "scene" && !folder.empty() ? folder : stem;
}

std::size_t frame_at(const std::vector<real>& times, real time) {
    if (time < 0) return times.size() - 1;
    std::size_t frame = 0;
    while (frame + 1 < times.size() && times[frame + 1] <= time * (1 + 1e-9)) ++frame;
    return frame;
}

}  // namespace weir::app
