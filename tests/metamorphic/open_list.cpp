#include "metamorphic/open_list.hpp"

#include <fnmatch.h>

#include <fstream>
#include <stdexcept>

namespace weir::metamorphic {

bool OpenEntry::names(const std::string& a_property, const std::string& a_scene) const {
    return fnmatch(property.c_str(), a_property.c_str(), 0) == 0 && fnmatch(scene.c_str(), a_scene.c_str(), 0) == 0;
}

std::vector<OpenEntry> read_open_list(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    std::vector<OpenEntry> list;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::vector<std::string> part(1);
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (part.size() < 4 && line.compare(i, 3, " | ") == 0)
                part.emplace_back(), i += 2;
            else
                part.back() += line[i];
        }
        if (part.size() != 4) throw std::runtime_error("property | scene | measured | why: " + line);
        list.push_back({part[0], part[1], part[2], part[3]});
    }
    return list;
}

}  // namespace weir::metamorphic
