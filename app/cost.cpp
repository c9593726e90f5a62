// weir cost: error against computing time.
#include "app/commands.hpp"
#include "core/parallel.hpp"
#include "validation/cost/command.hpp"

#include <memory>

namespace weir::app {

namespace {

struct CostArguments {
    validation::CostOptions options;
    std::string size = "ci", out = "out/cost", publish_to = "results/cost";
    int threads = 0;
    bool publish = false;
};

int cost(CostArguments& arguments) {
    if (arguments.threads > 0) set_threads(arguments.threads);
    arguments.options.size = arguments.size == "full" ? validation::Size::full : validation::Size::ci;
    arguments.options.out = arguments.out;
    if (arguments.publish) arguments.options.publish = arguments.publish_to;
    return validation::cost_command(arguments.options);
}

}  // namespace

void add_cost(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<CostArguments>();
    auto& options = arguments->options;
    CLI::App* command = app.add_subcommand("cost", "Measure error against computing time; failures stay in the table");
    command->add_option("names", options.names, "Cases by name, or folders");
    command->add_flag("--all", options.all, "Every ready study (cases/*/cost.toml)");
    command->add_flag("--list", options.list, "Show the ready studies; run nothing");
    command->add_option("--solver", options.solver, "Only methods that use this solver");
    command->add_option("--error", options.error, "Another metric as the error");
    command->add_option("--vary", options.vary, "key=value,value,...: settings to go through; may be given again")->allow_extra_args(false);
    command->add_option("--repeat", options.measure.repeats, "Runs of a setting that is quick; the median counts")
        ->check(CLI::Range(1, 99));
    command->add_option("--time-limit", options.measure.time_limit, "Seconds after which a run counts as failed")
        ->check(CLI::PositiveNumber);
    command->add_option("--size", arguments->size, "ci: minutes; full: as published")->check(CLI::IsMember({"ci", "full"}));
    command->add_option("--out", arguments->out, "Folder of tables and figures (default: out/cost)");
    command->add_option("--threads", arguments->threads, "Number of threads")->check(CLI::Range(1, 1024));
    command->add_flag("--publish", arguments->publish, "Write the page of results as well");
    command->add_option("--publish-to", arguments->publish_to, "Its folder (default: results/cost)");
    command->add_flag("--quiet", options.quiet, "No progress line");
    command->callback([arguments, &exit_code] { exit_code = cost(*arguments); });
}

}  // namespace weir::app
