// weir list WHAT: the names that scenes and commands may use.
#include "app/commands.hpp"
#include "app/output_fields.hpp"
#include "backend/device.hpp"
#include "core/error.hpp"
#include "sim/registry.hpp"
#include "validation/report/command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace weir::app {

namespace {

/// The solvers, or the problems of the validation suite that scenes name in the place of one.
void list_solvers(bool studies) {
    for (const auto& schema : sim::schemas())
        if (schema.study == studies) std::printf("%-14s %s\n", schema.name.c_str(), schema.doc.c_str());
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

/// OpenCL devices, numbered as scheme.backend = "opencl:N" counts them.
void list_devices() {
    const auto devices = backend::devices();
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const auto& d = devices[i];
        std::printf("opencl:%zu  %s (%s), %d units, %zu MiB%s\n          %s; %s, driver %s\n", i, d.name.c_str(), d.kind.c_str(), d.units,
                    d.memory >> 20, d.doubles ? "" : ", no double precision: not usable", d.platform.c_str(), d.version.c_str(),
                    d.driver.c_str());
    }
    if (devices.empty()) backend::open_device(0);  // throws, and says what is missing
}

}  // namespace

void add_list(CLI::App& app, int& exit_code) {
    auto what = std::make_shared<std::string>();
    auto folder = std::make_shared<std::string>(validation::case_root().string());
    CLI::App* list = app.add_subcommand("list",
                                        "List the solvers, their effects, their fields and integrals, the problems of the validation suite "
                                        "(studies), the cases (* where they are "
                                        "validated), or the devices");
    list->add_option("what", *what, "solvers, effects, fields, studies, cases or devices")->required()->check(CLI::IsMember(listed));
    list->add_option("--cases", *folder, "Folder of the cases");
    auto markdown = std::make_shared<bool>(false);
    list->add_flag("--markdown", *markdown, "Print the reference of fields (docs/fields.md)");
    list->callback([what, folder, markdown, &exit_code] {
        exit_code = exit_success;
        if (*what == "solvers" || *what == "studies") list_solvers(*what == "studies");
        if (*what == "effects") list_effects();
        if (*what == "fields") std::fputs((*markdown ? output_fields_markdown() : output_fields_text()).c_str(), stdout);
        if (*what == "cases") list_cases(*folder);
        if (*what == "devices") list_devices();
    });
}

}  // namespace weir::app
