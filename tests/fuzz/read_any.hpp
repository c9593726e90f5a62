// What the fuzzer and the test that replays its findings both do with a text.
#pragma once
#include "unit/scene/schema.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace weir::test {

/// True: a scene; false: refused, with a message. Lines at the beginning that start with "#!" are overrides. Ends the program where
/// a scene that was written out does not read back as itself; lets every exception but BadInput pass.
inline bool read_any(std::string_view text) {
    std::vector<scene::Override> overrides;
    try {
        while (text.starts_with("#!") && overrides.size() < 8) {
            const auto line = text.substr(0, text.find('\n'));
            overrides.push_back(scene::to_override(line.substr(2)));
            text.remove_prefix(line.size() < text.size() ? line.size() + 1 : line.size());
        }
        const auto read = scene::parse(text, "fuzz.toml", scene::made_up::schemas(), overrides);
        const auto written = scene::to_toml(read.root());
        if (scene::to_toml(scene::parse(written, "again.toml", scene::made_up::schemas()).root()) != written) {
            std::fprintf(stderr, "reads back differently:\n%s", written.c_str());
            std::abort();
        }
        return true;
    } catch (const BadInput& e) {
        if (e.what()[0] == '\0') std::abort();
        return false;
    }
}

}  // namespace weir::test
