// weir plan: which setting to take for a budget of time and of error.
#include "validation/cost/plan.hpp"
#include "app/commands.hpp"

#include <memory>

namespace weir::app {

void add_plan(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<validation::PlanOptions>();
    CLI::App* command =
        app.add_subcommand("plan", "Which setting to take for a budget, as a command; exit code 1 if no measured one reaches it");
    command->add_option("scene", options->name, "A case with a study of cost (weir cost --list), by name or folder")->required();
    command->add_option(
        "--budget", options->budget,
        "Computing time of a frame, or of a step where the study counts steps: 16ms; alone: the most accurate that it buys");
    command->add_option("--error", options->error, "How wrong the result may be: 2%, or a number; alone: the cheapest that is so good");
    command->add_option("--frame", options->frame, "Simulated time of a frame (default: a sixtieth of a second)");
    command->add_option("--tables", options->tables, "Folder of the tables (default: results/cost here, or as installed)");
    command->add_flag("--as-measured", options->as_measured,
                      "Milliseconds of another machine as they are, without measuring some again here");
    command->callback([options, &exit_code] { exit_code = validation::plan_command(*options); });
}

}  // namespace weir::app
