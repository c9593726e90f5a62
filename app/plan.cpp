// weir plan: which setting to take for a budget of time and of error.
#include "app/commands.hpp"
#include "validation/cost/recommend.hpp"

#include <memory>

namespace weir::app {

void add_plan(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<validation::PlanOptions>();
    auto size = std::make_shared<std::string>("ci");
    CLI::App* command = app.add_subcommand("plan", "Which setting to take for a budget; exit code 1 if no measured one reaches it");
    command->add_option("scene", options->name, "A case with a study of cost (weir cost --list), by name or folder")->required();
    command->add_option("--budget", options->budget, "Computing time of a frame, or of a step where the study counts steps: 16ms");
    command->add_option("--error", options->error, "How wrong the result may be: 2%, or a number")->required();
    command->add_option("--frame", options->frame, "Simulated time of a frame (default: a sixtieth of a second)");
    command->add_option("--tables", options->tables, "Folder of the tables (default: results/cost)");
    command->add_option("--size", *size, "The size at which the tables were measured")->check(CLI::IsMember({"ci", "full"}));
    command->callback([options, size, &exit_code] {
        options->size = *size == "full" ? validation::Size::full : validation::Size::ci;
        exit_code = validation::plan_command(*options);
    });
}

}  // namespace weir::app
