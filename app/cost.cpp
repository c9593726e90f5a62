// weir cost: error against computing time.
#include "app/commands.hpp"
#include "app/study_arguments.hpp"
#include "validation/cost/command.hpp"

#include <memory>

namespace weir::app {

void add_cost(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<StudyArguments<validation::CostOptions>>("out/cost", "results/cost");
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
    command->callback([arguments, &exit_code] { exit_code = validation::cost_command(arguments->chosen()); });
}

}  // namespace weir::app
