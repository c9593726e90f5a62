// weir plan: which configuration to take for a budget of time and of error, of a scene of one's own or of a case.
#include "validation/cost/plan.hpp"
#include "app/commands.hpp"
#include "validation/cost/study.hpp"
#include "validation/uncertainty/coverage_scenes.hpp"
#include "validation/uncertainty/scene_plan.hpp"

#include <fmt/format.h>

#include <memory>

namespace weir::app {

namespace {

struct PlanArguments {
    validation::PlanOptions study;
    validation::ScenePlanOptions scene;
    std::vector<std::string> set;
    bool coverage = false;
};

/// Returns whether a study of cost belongs to the word: a case by name or folder.
bool has_study(const std::string& word) {
    try {
        return std::filesystem::exists(validation::find_case(word) / "cost.toml");
    } catch (const BadInput&) {
        return false;
    }
}

int print_coverage(const validation::ScenePlanOptions& options) {
    const auto tell = [&](const std::string& line) {
        if (!options.quiet) fmt::print(stderr, "{}\n", line);
    };
    fmt::print("{}", validation::coverage_text(validation::run_coverage_scenes(options.scene, sim::registry(), tell)));
    return 0;
}

int plan(PlanArguments& arguments) {
    if (arguments.coverage) return print_coverage(arguments.scene);
    const bool of_scene = !arguments.scene.of.empty() || !has_study(arguments.scene.scene);
    if (!of_scene) {
        if (arguments.scene.error.size() > 1) throw BadInput("--error: a study of cost has one error");
        if (!arguments.set.empty() || !arguments.scene.with.empty())
            throw BadInput("--set and --with require --of: a quantity of the scene");
        arguments.study.name = arguments.scene.scene;
        arguments.study.budget = arguments.scene.budget, arguments.study.frame = arguments.scene.frame;
        if (!arguments.scene.error.empty()) arguments.study.error = arguments.scene.error.front();
        return validation::plan_command(arguments.study);
    }
    if (arguments.study.as_measured || !arguments.study.tables.empty())
        throw BadInput("--as-measured and --tables belong to the study of a case; a quantity of a scene (--of) is measured here");
    for (const auto& text : arguments.set) arguments.scene.set.push_back(scene::to_override(text));
    return validation::scene_plan_command(arguments.scene, sim::registry());
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<PlanArguments>();
    auto& scene = arguments->scene;
    CLI::App* command = app.add_subcommand(
        "plan",
        "Recommend a configuration for a budget, as a command. With --of: of any scene, from a ladder of grids, with the uncertainty of "
        "each value. Without: of a case, from its published study of cost. Exit code 1 if no configuration meets the request");
    command->add_option("scene", scene.scene, "A scene, or a case by name or folder")->required();
    command
        ->add_option("--of", scene.of,
                     "A quantity: PROBE[.COLUMN][.STATISTIC][@WHEN] or INTEGRAL[.STATISTIC][@WHEN]; may be repeated. Statistics: end, max, "
                     "min, mean, rms, range, drift, change, time_of_max, time_of_min, time_of(>LEVEL), period, curve, picture. WHEN: @2.5, "
                     "@0.8.., @0.8..2")
        ->allow_extra_args(false);
    command
        ->add_option(
            "--error", scene.error,
            "Largest error: a percentage (with --of: of the quantity's range, or of its value), or a value such as 2mm; once, or once "
            "per quantity. Without --budget: the least expensive configuration that meets it")
        ->allow_extra_args(false);
    command->add_option("--budget", scene.budget,
                        "Computing time per frame, or per step where the study counts steps, such as 16ms; without --error: the most "
                        "accurate configuration within the budget");
    command->add_option("--frame", scene.frame, "Simulated time per frame (default: a sixtieth of a second)");
    command->add_option("--with", scene.with,
                        "With --of: compare with other methods, such as tallcell,shallow_water,pbf or mac_water:scheme.transfer=apic");
    command->add_option("--time-limit", scene.time_limit, "With --of: computing time of one run at most (default: 120s)");
    command->add_option("--set", arguments->set, "With --of: override a key")->type_name("KEY=VALUE")->allow_extra_args(false);
    command->add_option("--out", scene.out,
                        "With --of: folder of plan.json, plan.svg, index.html and the kept runs (default: out/NAME/plan)");
    command->add_option("--tables", arguments->study.tables, "Folder of the tables (default: results/cost here, or as installed)");
    command->add_flag("--as-measured", arguments->study.as_measured,
                      "Use the published times unscaled, without measuring some of them again on this machine");
    command->add_flag("--coverage", arguments->coverage,
                      "The scene is a file of scenes with known results, such as cases/error_bars/data/scene.toml: print how often the "
                      "uncertainties contain the true error");
    command->add_flag("--quiet", scene.quiet, "No progress on the terminal");
    command->callback([arguments, &exit_code] { exit_code = plan(*arguments); });
}

}  // namespace weir::app
