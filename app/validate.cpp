// weir validate: runs cases and judges their claims.
#include "app/commands.hpp"
#include "app/study_arguments.hpp"
#include "validation/report/command.hpp"

#include <memory>

namespace weir::app {

void add_validate(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<StudyArguments<validation::ValidateOptions>>("out/validate", "results");
    CLI::App* command = app.add_subcommand("validate", "Run cases and evaluate their claims; exit code 1 if one fails");
    arguments->add_to(*command, "Run every case", "ci: minutes; full: as published", "Folder of verdicts.json, svg/, csv/ and frames");
    command->add_option("--backend", arguments->options.backend,
                        "Backend of all particle runs: threads[:isa], opencl[:N] (weir list devices) or reference");
    command
        ->add_option("--compare", arguments->options.compare,
                     "Folder of published results: a value that differs from the published one fails (exit code 1)")
        ->check(CLI::ExistingDirectory);
    command
        ->add_option("--steps", arguments->options.steps,
                     "End each run after N steps, at the first value of its sweep: all code of a case runs, and no claim is evaluated")
        ->check(CLI::PositiveNumber);
    command->add_flag("--report", arguments->options.page, "Publish, and write all published results as one HTML page");
    command->callback([arguments, &exit_code] {
        arguments->publish |= arguments->options.page;
        exit_code = validation::validate_command(arguments->chosen());
    });
}

}  // namespace weir::app
