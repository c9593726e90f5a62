// weir validate: runs cases and judges their claims.
#include "app/commands.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "validation/report/command.hpp"

#include <memory>

namespace weir::app {

namespace {

struct ValidateArguments {
    validation::ValidateOptions options;
    std::string size = "ci", out = "out/validate", publish_to = "results";
    int threads = 0;
    bool publish = false;
};

int validate(ValidateArguments& arguments) {
    if (arguments.threads > 0) set_threads(arguments.threads);
    arguments.options.size = arguments.size == "full" ? validation::Size::full : validation::Size::ci;
    arguments.options.out = arguments.out;
    if (arguments.publish) arguments.options.publish = arguments.publish_to;
    return validation::validate_command(arguments.options);
}

}  // namespace

void add_validate(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<ValidateArguments>();
    CLI::App* command = app.add_subcommand("validate", "Run cases and judge their claims; exit code 1 if one fails");
    command->add_option("names", arguments->options.names, "Cases by name, or folders with a case.toml");
    command->add_flag("--all", arguments->options.all, "Every case");
    command->add_flag("--list", arguments->options.list, "Show the cases; run nothing");
    command->add_option("--size", arguments->size, "ci: minutes; full: as published")->check(CLI::IsMember({"ci", "full"}));
    command->add_option("--out", arguments->out, "Folder of verdicts.json, svg/, csv/ and frames (default: out/validate)");
    command->add_option("--threads", arguments->threads, "Number of threads; results do not depend on it")->check(CLI::Range(1, 1024));
    command->add_flag("--publish", arguments->publish, "Write the page of results as well");
    command->add_option("--publish-to", arguments->publish_to, "Its folder (default: results)");
    command->add_flag("--quiet", arguments->options.quiet, "No progress line");
    command->callback([arguments, &exit_code] { exit_code = validate(*arguments); });
}

}  // namespace weir::app
