#include "sim/scene_files.hpp"

#include "core/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
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
    for (const SceneFile& file : files) lines += fmt::format("{:016x} {}\n", file.contents, file.name);
    return lines;
}

std::string changed_file(const std::string& here, const std::string& there) {
    std::istringstream lines(here);
    for (std::string line; std::getline(lines, line);) {
        const std::string name = line.substr(std::min(line.size(), line.find(' ') + 1));
        if (there.find(" " + name + "\n") != std::string::npos && there.find(line + "\n") == std::string::npos) return name;
    }
    return "";
}

}  // namespace weir::sim
