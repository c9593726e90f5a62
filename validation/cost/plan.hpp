// `weir plan`: a setting out of the tables of `weir cost`, as a command that runs it, priced for this machine.
#pragma once
#include "sim/registry.hpp"
#include "validation/cost/recommend.hpp"

#include <filesystem>
#include <string>

namespace weir::validation {

struct PlanOptions {
    std::string name{};                      // of a case with a study
    std::string budget{}, error{}, frame{};  // as typed; an empty frame is a sixtieth of a second
    std::filesystem::path tables{};          // empty: ./results/cost, or those installed with this program, or of its source
    bool as_measured = false;                // tables of another machine stay as they are
};
/// What the tables say of a case, for this machine, and what follows for the budget.
struct Plan {
    Study study;
    Budget budget;
    std::vector<CostCurve> curves;
    std::string prices;             // where the milliseconds come from, in words
    Recommendation recommendation;  // points into `curves`
};
/// Throws BadInput.
Plan make_plan(const PlanOptions& options, const Solvers& solvers = sim::registry());

/// Runs the command and returns its exit code: 1 where no setting reaches what is asked. Throws BadInput.
int plan_command(const PlanOptions& options, const Solvers& solvers = sim::registry());

/// The command that runs a study's setting as it was measured: its scene, everything that the study changes in it, its threads; and has
/// the run measure the study's error.
std::string run_line(const Study& study, const CostCurve& curve, const Priced& at, const Solvers& solvers = sim::registry());

/// A word for a POSIX shell.
std::string shell_word(const std::string& text);

}  // namespace weir::validation
