// weir cost: error against computing time.
#include "app/commands.hpp"
#include "app/study_arguments.hpp"
#include "core/error.hpp"
#include "core/programs.hpp"
#include "sim/registry.hpp"
#include "validation/cost/command.hpp"
#include "validation/cost/cost_estimate.hpp"
#include "validation/cost/effect_cost.hpp"
#include "validation/cost/parallel_estimate.hpp"
#include "validation/report/command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

namespace weir::app {

namespace {

constexpr const char* window_seconds = "5s";

struct CostArguments : StudyArguments<validation::CostOptions> {
    std::string plan;
    std::vector<std::string> set;
    bool effects = false;
    int ranks = 0;
    double latency = 0, bandwidth = 0;
    CostArguments() : StudyArguments("out/cost", "results/cost") {}
};

/// The network that is named; none: what this machine has.
std::optional<validation::Link> link_of(const CostArguments& arguments) {
    if ((arguments.latency > 0) != (arguments.bandwidth > 0)) throw BadInput("--latency and --bandwidth describe one network: give both");
    if (arguments.latency == 0) return std::nullopt;
    return validation::Link{arguments.latency, arguments.bandwidth, "as given"};
}

/// Before it runs: what a scene is made of and will cost.
int estimate_cost(const CostArguments& arguments) {
    std::vector<scene::Override> overrides;
    for (const auto& text : arguments.set) overrides.push_back(scene::to_override(text));
    const scene::Scene scene = scene::read(validation::scene_named(arguments.plan), sim::schemas(), overrides);
    if (arguments.ranks > 0) sim::require_ranks(scene, arguments.ranks);
    const validation::CostEstimate f = validation::estimate_cost(scene);
    std::fputs(validation::cost_estimate_text(f, scene).c_str(), stdout);
    if (arguments.ranks > 0)
        std::fputs(
            validation::parallel_estimate_text(validation::estimate_in_parallel(scene, f, arguments.ranks, link_of(arguments)), f, scene)
                .c_str(),
            stdout);
    return exit_success;
}

/// Frames a second of weir-live, on the display that there is or on one without a screen; NaN where there is neither, or no viewer.
double frames_in_window(const std::filesystem::path& scene, const std::vector<scene::Override>& set) {
    const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "weir-live";
    if (!std::filesystem::exists(program)) return NAN;
    std::vector<std::string> words;
    if (!std::getenv("DISPLAY")) words = {"xvfb-run", "-a", "-s", "-screen 0 1280x1024x24"};
    words.insert(words.end(), {program.string(), file_argument(scene), "--bench", window_seconds, "--fast", "--json"});
    for (const auto& change : set) words.insert(words.end(), {"--set", change.key + "=" + change.value});
    const auto said = output_of_program(words);
    if (!said) return NAN;
    const auto measured = nlohmann::json::parse(*said, nullptr, false);
    return measured.is_object() ? measured.value("frames_a_second", NAN) : NAN;
}

int cost(CostArguments& arguments) {
    arguments.options.drawn = frames_in_window;
    const auto& options = arguments.chosen();
    if (!arguments.plan.empty()) return estimate_cost(arguments);
    if (arguments.ranks > 0) throw BadInput("--ranks estimates a scene in parallel (MPI): it requires --plan SCENE");
    if (!arguments.effects) return validation::cost_command(options);
    std::vector<std::filesystem::path> folders{arguments.out};
    if (arguments.publish) folders.push_back(arguments.publish_to);
    return validation::effects_command({.solver = options.solver}, folders, options.quiet);
}

}  // namespace

void add_cost(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<CostArguments>();
    auto& options = arguments->options;
    CLI::App* command = app.add_subcommand("cost", "Measure error against computing time; failed configurations stay in the table");
    arguments->add_to(*command, "Run every study (cases/*/cost.toml)", "ci: minutes; full: as published", "Folder of tables and plots");
    command->add_flag("--report-table", options.report_table, "Table of the earlier report's values beside weir's");
    command->add_option("--solver", options.solver, "Only methods that use this solver");
    command->add_option("--error", options.error, "Use this metric as the error");
    command->add_option("--vary", options.vary, "key=value,value,...: configurations to measure; may be repeated")->allow_extra_args(false);
    command->add_option("--repeat", options.measure.repeats, "Repeated runs of a short configuration; the median is taken")
        ->check(CLI::Range(1, 99));
    command->add_option("--time-limit", options.measure.time_limit, "Time limit of a run [s]; a longer run fails")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--compare", options.compare,
                     "Folder of published tables: compare errors and bytes at ci size, one run per configuration; a changed value fails "
                     "(exit code 1)")
        ->check(CLI::ExistingDirectory);
    command->add_flag("--effects", arguments->effects, "Measure the cost of each effect of each solver: effects.csv and effects.md");
    command->add_option("--plan", arguments->plan,
                        "Estimate memory and time per step of a scene or a case before it runs; nothing is written");
    command->add_option("--ranks", arguments->ranks, "With --plan: number of MPI ranks; estimate their memory, messages and weak scaling")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--latency", arguments->latency,
                     "With --ranks: latency of a message between ranks [s] (default: measured through this machine's memory)")
        ->check(CLI::PositiveNumber);
    command->add_option("--bandwidth", arguments->bandwidth, "With --latency: bandwidth between ranks [bytes/s]")
        ->check(CLI::PositiveNumber);
    command->add_option("--set", arguments->set, "With --plan: override a key")->type_name("KEY=VALUE")->allow_extra_args(false);
    command->callback([arguments, &exit_code] { exit_code = cost(*arguments); });
}

}  // namespace weir::app
