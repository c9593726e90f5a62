// weir stability: raises a key until something breaks.
#include "app/commands.hpp"
#include "core/parallel.hpp"
#include "validation/stability/command.hpp"

#include <memory>

namespace weir::app {

namespace {

struct StabilityArguments {
    validation::StabilityOptions options;
    std::string size = "ci", out = "out/stability", publish_to = "results/stability";
    int threads = 0;
    bool publish = false;
};

int stability(StabilityArguments& arguments) {
    if (arguments.threads > 0) set_threads(arguments.threads);
    arguments.options.size = arguments.size == "full" ? validation::Size::full : validation::Size::ci;
    arguments.options.out = arguments.out;
    if (arguments.publish) arguments.options.publish = arguments.publish_to;
    return validation::stability_command(arguments.options);
}

}  // namespace

void add_stability(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<StabilityArguments>();
    auto& options = arguments->options;
    CLI::App* command = app.add_subcommand("stability", "Find how far solvers can be pushed; exit code 1 if one falls below its floor");
    command->add_option("names", options.names, "Cases by name, or folders");
    command->add_flag("--all", options.all, "Every case with a stability.toml");
    command->add_flag("--list", options.list, "Show the axes; run nothing");
    command->add_flag("--floors", options.floors, "Only check that each floor holds: one run an axis");
    command->add_option("--axis", options.axis, "Only this axis");
    command->add_option("--size", arguments->size, "ci: limits within a factor 1.5; full: 1.1")->check(CLI::IsMember({"ci", "full"}));
    command->add_option("--out", arguments->out, "Folder of what was found (default: out/stability)");
    command->add_option("--threads", arguments->threads, "Number of threads; results do not depend on it")->check(CLI::Range(1, 1024));
    command->add_flag("--publish", arguments->publish, "Write the page of results as well");
    command->add_option("--publish-to", arguments->publish_to, "Its folder (default: results/stability)");
    command->add_flag("--quiet", options.quiet, "No progress line");
    command->callback([arguments, &exit_code] { exit_code = stability(*arguments); });
}

}  // namespace weir::app
