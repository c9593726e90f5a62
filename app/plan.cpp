// weir plan: which setting to take for a budget of time and of error.
#include "validation/cost/plan.hpp"
#include "app/commands.hpp"

#include <memory>

namespace weir::app {

void add_plan(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<validation::PlanOptions>();
    CLI::App* command =
        app.add_subcommand("plan", "Recommend a configuration for a budget, as a command; exit code 1 if no measured one meets it");
    command->add_option("scene", options->name, "A case with a study of cost (weir cost --list), by name or folder")->required();
    command->add_option("--budget", options->budget,
                        "Computing time per frame, or per step where the study counts steps, such as 16ms; without --error: the most "
                        "accurate configuration within the budget");
    command->add_option("--error", options->error,
                        "Largest error of the result: 2%, or a number; without --budget: the cheapest configuration that meets it");
    command->add_option("--frame", options->frame, "Simulated time per frame (default: a sixtieth of a second)");
    command->add_option("--tables", options->tables, "Folder of the tables (default: results/cost here, or as installed)");
    command->add_flag("--as-measured", options->as_measured,
                      "Use the published times unscaled, without measuring some of them again on this machine");
    command->callback([options, &exit_code] { exit_code = validation::plan_command(*options); });
}

}  // namespace weir::app
