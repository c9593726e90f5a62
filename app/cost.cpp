// weir cost: error against computing time.
#include "app/commands.hpp"
#include "app/study_arguments.hpp"
#include "core/error.hpp"
#include "sim/registry.hpp"
#include "validation/cost/command.hpp"
#include "validation/cost/effect_cost.hpp"
#include "validation/cost/forecast.hpp"
#include "validation/report/command.hpp"

#include <cstdio>
#include <memory>

namespace weir::app {

namespace {

struct CostArguments : StudyArguments<validation::CostOptions> {
    std::string plan;
    std::vector<std::string> set;
    bool effects = false;
    CostArguments() : StudyArguments("out/cost", "results/cost") {}
};

/// Before it runs: what a scene is made of and will cost.
int forecast(const CostArguments& arguments) {
    std::vector<scene::Override> overrides;
    for (const auto& text : arguments.set) overrides.push_back(scene::to_override(text));
    const scene::Scene scene = scene::read(validation::scene_named(arguments.plan), sim::schemas(), overrides);
    std::fputs(validation::forecast_text(validation::forecast(scene), scene).c_str(), stdout);
    return exit_success;
}

int cost(CostArguments& arguments) {
    const auto& options = arguments.chosen();
    if (!arguments.plan.empty()) return forecast(arguments);
    if (!arguments.effects) return validation::cost_command(options);
    std::vector<std::filesystem::path> folders{arguments.out};
    if (arguments.publish) folders.push_back(arguments.publish_to);
    return validation::effects_command({.solver = options.solver}, folders, options.quiet);
}

}  // namespace

void add_cost(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<CostArguments>();
    auto& options = arguments->options;
    CLI::App* command = app.add_subcommand("cost", "Measure error against computing time; failures stay in the table");
    arguments->add_to(*command, "Every ready study (cases/*/cost.toml)", "ci: minutes; full: as published", "Folder of tables and figures");
    command->add_flag("--report-table", options.report_table, "The figures of the report that began this work, beside ours");
    command->add_option("--solver", options.solver, "Only methods that use this solver");
    command->add_option("--error", options.error, "Another metric as the error");
    command->add_option("--vary", options.vary, "key=value,value,...: settings to go through; may be given again")->allow_extra_args(false);
    command->add_option("--repeat", options.measure.repeats, "Runs of a setting that is quick; the median counts")
        ->check(CLI::Range(1, 99));
    command->add_option("--time-limit", options.measure.time_limit, "Seconds after which a run counts as failed")
        ->check(CLI::PositiveNumber);
    command->add_flag("--effects", arguments->effects, "What each effect of each solver costs: effects.csv and effects.md");
    command->add_option("--plan", arguments->plan,
                        "A scene or a case: its memory and the time of its steps, before it runs; nothing is written");
    command->add_option("--set", arguments->set, "With --plan: override a key")->type_name("KEY=VALUE")->allow_extra_args(false);
    command->callback([arguments, &exit_code] { exit_code = cost(*arguments); });
}

}  // namespace weir::app
