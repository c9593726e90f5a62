#include "sim/scene_files.hpp"

#include "core/words.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <variant>

namespace weir::sim {

namespace {

void collect(const scene::Table& table, std::vector<SceneFile>& to) {
    for (const std::string& key : table.keys()) {
        const scene::Value& value = *table.find(key);
        if (const auto* inner = std::get_if<scene::Table>(&value)) collect(*inner, to);
        if (const auto* list = std::get_if<std::vector<scene::Table>>(&value))
            for (const scene::Table& each : *list) collect(each, to);
        if (const auto* name = std::get_if<std::string>(&value); name && key == "file" && !name->empty())
            to.push_back({*name, digest(bytes_of(table.file(key)))});
    }
}

std::string line_of(const SceneFile& file) { return fmt::format("{:016x} {}\n", file.contents, file.name); }

}  // namespace

std::uint64_t digest(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return hash;
}

std::vector<SceneFile> scene_files(const scene::Scene& scene) {
    const scene::Table root = scene.root();  // a copy: that its keys are read here does not count as use
    std::vector<SceneFile> files;
    collect(root, files);
    return files;
}

std::string lines_of(const std::vector<SceneFile>& files) {
    std::string lines;
    for (const SceneFile& file : files) lines += line_of(file);
    return lines;
}

std::string changed_file(const std::vector<SceneFile>& here, std::string_view lines) {
    for (const SceneFile& file : here)
        if (lines.find(" " + file.name + "\n") != std::string_view::npos && lines.find(line_of(file)) == std::string_view::npos)
            return file.name;
    return "";
}

}  // namespace weir::sim
