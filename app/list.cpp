// weir list WHAT: the names that scenes and commands may use.
#include "app/commands.hpp"
#include "core/error.hpp"
#include "sim/registry.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace weir::app {

namespace {

void list_solvers() {
    for (const auto& schema : sim::schemas()) std::printf("%-14s %s\n", schema.name.c_str(), schema.doc.c_str());
}

void list_effects() {
    for (const auto& schema : sim::schemas()) {
        std::printf("%s\n", schema.name.c_str());
        for (const auto& effect : schema.effects) std::printf("  %-18s %s\n", effect.name.c_str(), effect.doc.c_str());
    }
}

/// Folders with a scene, sorted; with a star where a case.toml claims something about it.
void list_cases(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder))
        throw BadInput("no folder \"" + folder.string() + "\" with cases here; name it with --cases");
    std::vector<std::filesystem::path> cases;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (std::filesystem::exists(entry.path() / "scene.toml")) cases.push_back(entry.path());
    std::sort(cases.begin(), cases.end());
    for (const auto& path : cases) std::printf("%s%s\n", path.filename().c_str(), std::filesystem::exists(path / "case.toml") ? " *" : "");
}

}  // namespace

void add_list(CLI::App& app, int& exit_code) {
    auto what = std::make_shared<std::string>();
    auto folder = std::make_shared<std::string>("cases");
    CLI::App* list = app.add_subcommand("list", "List the solvers, the effects of each, or the cases (* where they are validated)");
    list->add_option("what", *what, "solvers, effects or cases")->required()->check(CLI::IsMember({"solvers", "effects", "cases"}));
    list->add_option("--cases", *folder, "Folder of the cases");
    list->callback([what, folder, &exit_code] {
        exit_code = exit_success;
        if (*what == "solvers") list_solvers();
        if (*what == "effects") list_effects();
        if (*what == "cases") list_cases(*folder);
    });
}

}  // namespace weir::app
