#include "input/bad_folder.hpp"
#include "scene/describe.hpp"
#include "sim/registry.hpp"
#include "support/test.hpp"

using namespace weir;

TEST("docs/scene.md is what weir describe --markdown writes") {
    const auto file = std::filesystem::path(WEIR_SOURCE_DIR) / "docs/scene.md";
    EXPECT_EQ(scene::manual(sim::schemas()), test::content(file)) << "run: weir describe --markdown > docs/scene.md";
}

TEST("the manual has the keys that all variants of a solver's own table share") {
    const std::string manual = scene::manual(sim::schemas());
    for (const char* key : {"| `waves.level` |", "| `bodies[].density` |", "| `heaters[].power` |"})
        EXPECT_NE(manual.find(key), std::string::npos) << key;
}

TEST("every key, variant and effect of the program can be described, and says what it is") {
    const auto check = [](const auto& self, const std::vector<scene::Key>& keys, const std::string& path) -> void {
        for (const auto& key : keys) {
            EXPECT_FALSE(key.doc.empty()) << path << key.name;
            self(self, key.keys, path + key.name + ".");
            if (key.variants_from) continue;  // shapes contain themselves
            for (const auto& v : key.variants) {
                EXPECT_FALSE(v.doc.empty()) << path << key.name << " " << v.name;
                self(self, v.keys, path + key.name + "." + v.name + ".");
            }
        }
    };
    for (const auto& solver : sim::schemas()) {
        check(check, scene::keys_of(solver), solver.name + ": ");
        EXPECT_FALSE(scene::describe(solver.name, sim::schemas()).empty());
        for (const auto& effect : solver.effects) EXPECT_FALSE(scene::describe(effect.name, sim::schemas()).empty());
    }
}
