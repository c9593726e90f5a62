// `weir cost`: what accuracy costs in time.
#pragma once
#include "sim/registry.hpp"
#include "validation/cost/measure.hpp"
#include "validation/cost/report_table.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::validation {

struct CostOptions {
    std::vector<std::string> names{};  // cases by name, or folders
    bool all = false;                  // every case with a cost.toml
    bool list = false;                 // name and question of each, nothing is run
    bool report_table = false;         // the table of cases/report_table, and nothing else
    std::string solver{};              // only methods whose scene names this solver
    std::string error{};               // another metric than the study's
    std::vector<std::string> vary{};   // "key=value,value,..."
    Size size = Size::ci;
    MeasureOptions measure{};
    Drawn drawn{};                           // of the report's table: what a window reaches
    std::filesystem::path out = "out/cost";  // <study>.csv, .json, .svg
    std::filesystem::path publish{};         // folder of the published page; empty: not published
    std::filesystem::path compare{};         // published folder to compare errors and bytes of the ci size with; empty: measured as usual
    bool quiet = false;
};

/// Runs the command and returns its exit code. A setting that fails stays in the table and is no error of the command; a study in which
/// every setting failed is (exit code 1), and so is a published table that is older than the code. Throws BadInput before anything is run.
int cost_command(const CostOptions& options, const Solvers& solvers = sim::registry());

}  // namespace weir::validation
