// The list of properties that are known not to hold in some scenes.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace weir::metamorphic {

struct OpenEntry {
    std::string property, scene, measured, why;
    int used = 0;
    bool names(const std::string& a_property, const std::string& a_scene) const;
};

std::vector<OpenEntry> read_open_list(const std::filesystem::path& file);

}  // namespace weir::metamorphic
