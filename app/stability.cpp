// weir stability: raises a key until something breaks.
#include "app/commands.hpp"
#include "app/study_arguments.hpp"
#include "validation/stability/command.hpp"

#include <memory>

namespace weir::app {

void add_stability(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<StudyArguments<validation::StabilityOptions>>("out/stability", "results/stability");
    auto& options = arguments->options;
    CLI::App* command = app.add_subcommand("stability", "Find how far solvers can be pushed; exit code 1 if one falls below its floor");
    arguments->add_to(*command, "Every case with a stability.toml", "ci: limits within a factor 1.5; full: 1.1",
                      "Folder of what was found");
    command->add_flag("--floors", options.floors, "Only check that each floor holds: one run an axis");
    command
        ->add_option("--compare", options.compare,
                     "Folder of published limits: one run at either end of each; one that moved fails (exit code 1)")
        ->check(CLI::ExistingDirectory);
    command->add_option("--axis", options.axis, "Only this axis");
    command->add_option("--steps", options.steps, "With --floors: end each run after N steps and judge nothing")
        ->check(CLI::PositiveNumber);
    command->callback([arguments, &exit_code] { exit_code = validation::stability_command(arguments->chosen()); });
}

}  // namespace weir::app
