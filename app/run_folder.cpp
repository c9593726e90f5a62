#include "app/run_folder.hpp"

#include "core/error.hpp"
#include "core/words.hpp"
#include "sim/registry.hpp"

#include <nlohmann/json.hpp>

namespace weir::app {

namespace {

/// Of what may have any shape: others write files of this name too.
std::string text_in(const std::filesystem::path& file, const nlohmann::json& scene, const char* key) {
    const auto found = scene.find(key);
    if (found == scene.end() || !found->is_string()) throw BadInput(file.string() + ": \"scene\" has no text \"" + key + '"');
    return found->get<std::string>();
}

nlohmann::json parsed(const std::filesystem::path& file) {
    try {
        return nlohmann::json::parse(bytes_of(file), nullptr, false);
    } catch (const BadInput&) {
        return nullptr;
    }
}

}  // namespace

scene::Scene scene_of_run(const std::filesystem::path& folder) {
    const auto file = folder / "run.json";
    const auto j = parsed(file);
    if (!j.is_object() || !j.contains("scene"))
        throw BadInput(folder.string() + " is not the output folder of a run: it has no readable run.json");
    const auto& kept = j["scene"];
    if (!kept.is_object()) throw BadInput(file.string() + ": \"scene\" is not an object");
    std::vector<scene::Override> overrides;
    if (const auto list = kept.find("overrides"); list != kept.end()) {
        if (!list->is_array()) throw BadInput(file.string() + ": \"overrides\" is not a list");
        for (const auto& text : *list) {
            if (!text.is_string()) throw BadInput(file.string() + ": \"overrides\" contains an entry that is not a text");
            overrides.push_back(scene::to_override(text.get<std::string>()));
        }
    }
    return scene::parse(text_in(file, kept, "source"), text_in(file, kept, "file"), sim::schemas(), overrides);
}

std::size_t frame_at(const std::vector<real>& times, real time) {
    if (time < 0) return times.size() - 1;
    std::size_t frame = 0;
    while (frame + 1 < times.size() && times[frame + 1] <= time * (1 + 1e-9)) ++frame;
    return frame;
}

}  // namespace weir::app
