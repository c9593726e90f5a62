// A text read as a scene, and written out and read back.
#pragma once
#include "core/error.hpp"
#include "scene/scene.hpp"

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::fuzz {

/// Ends the program where a scene, as it was written, does not read back as itself.
inline void require_same(const std::string& written, const scene::Scene& scene, const std::vector<scene::SolverSchema>& schemas) {
    std::string wrong;
    try {
        if (scene::to_toml(scene::parse(written, "again.toml", schemas).root()) == scene::to_toml(scene.root())) return;
        wrong = "reads back differently";
    } catch (const BadInput& e) {
        wrong = e.what();
    }
    std::fprintf(stderr, "%s\n%s", wrong.c_str(), written.c_str());
    std::abort();
}

/// The scene; nothing where it is refused, with a message. Lines at the beginning that start with "#!" are overrides. Ends the program
/// where a scene that was written out does not read back as itself; lets every exception but BadInput pass.
inline std::optional<scene::Scene> read_any(std::string_view text, const std::vector<scene::SolverSchema>& schemas) {
    std::vector<scene::Override> overrides;
    try {
        while (text.starts_with("#!") && overrides.size() < 8) {
            const auto line = text.substr(0, text.find('\n'));
            overrides.push_back(scene::to_override(line.substr(2)));
            text.remove_prefix(line.size() < text.size() ? line.size() + 1 : line.size());
        }
        auto read = scene::parse(text, "fuzz.toml", schemas, overrides);
        require_same(scene::to_toml(read.root()), read, schemas);
        return read;
    } catch (const BadInput& e) {
        if (e.what()[0] == '\0') std::abort();
        return std::nullopt;
    }
}

}  // namespace weir::fuzz
