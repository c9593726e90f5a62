// weir stability: raises a key until something breaks.
#include "app/commands.hpp"
#include "app/study_arguments.hpp"
#include "validation/stability/command.hpp"

#include <memory>

namespace weir::app {

void add_stability(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<StudyArguments<validation::StabilityOptions>>("out/stability", "results/stability");
    auto& options = arguments->options;
    CLI::App* command =
        app.add_subcommand("stability", "Find the stability limits of solvers; exit code 1 if a limit falls below its guaranteed range");
    arguments->add_to(*command, "Every case with a stability.toml", "ci: limits within a factor 1.5; full: 1.1", "Folder of results");
    command->add_flag("--floors", options.guaranteed_only, "Check only the guaranteed ranges: one run per axis");
    command
        ->add_option("--compare", options.compare,
                     "Folder of published limits: one run on either side of each limit; a changed limit fails (exit code 1)")
        ->check(CLI::ExistingDirectory);
    command->add_option("--axis", options.axis, "Only this axis");
    command->add_option("--steps", options.steps, "With --floors: end each run after N steps and evaluate nothing")
        ->check(CLI::PositiveNumber);
    command->callback([arguments, &exit_code] { exit_code = validation::stability_command(arguments->chosen()); });
}

}  // namespace weir::app
