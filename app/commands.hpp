// The subcommands of `weir`: each adds itself to the command line and returns the exit code when it is called.
#pragma once
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

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

/// What `weir list` takes.
inline const std::vector<std::string> listed{"solvers", "effects", "fields", "studies", "cases", "devices"};

/// The command line as a page for man, and as completion for bash: from the commands themselves.
std::string man_page(const CLI::App& app);
std::string bash_completion(const CLI::App& app);

}  // namespace weir::app
