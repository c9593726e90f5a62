// The subcommands of `weir`: each adds itself to the command line and returns the exit code when it is called.
#pragma once
#include <CLI/CLI.hpp>

namespace weir::app {

void add_run(CLI::App& app, int& exit_code);
void add_picture(CLI::App& app, int& exit_code);
void add_movie(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_live(CLI::App& app, int& exit_code);
void add_describe(CLI::App& app, int& exit_code);
void add_list(CLI::App& app, int& exit_code);
void add_validate(CLI::App& app, int& exit_code);
void add_plan(CLI::App& app, int& exit_code);
void add_cost(CLI::App& app, int& exit_code);
void add_stability(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);

}  // namespace weir::app
