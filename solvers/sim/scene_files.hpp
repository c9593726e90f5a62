// The files that a scene reads besides its own, meshes and terrain, by their contents: a scene whose mesh has changed is another scene.
#pragma once
#include "scene/scene.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace weir::sim {

/// FNV-1a over 64 bits (Fowler, Noll & Vo).
std::uint64_t digest(std::string_view text);

struct SceneFile {
    std::string name;  // as the scene names it
    std::uint64_t contents;
};

/// The files that keys `file` of the scene name, in the order of the scene. Throws BadInput where one cannot be read.
std::vector<SceneFile> scene_files(const scene::Scene& scene);
/// One line each: contents as 16 hexadecimal digits, a blank, the name.
std::string lines_of(const std::vector<SceneFile>& files);
/// The first file of `here` that `there` has with other contents, both as lines_of(); empty: none.
std::string changed_file(const std::string& here, const std::string& there);

}  // namespace weir::sim
