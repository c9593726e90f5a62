// Which setting to take: what the tables of `weir cost` measured, read between their entries, against a budget of time and of error.
#pragma once
#include "validation/cost/study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// What a table says of one setting, or what is read between two of them.
struct Priced {
    real setting = 0;  // cells along x, iterations
    real error = 0;
    double seconds_per_second = 0, ms_per_step = 0;
};

/// One method of a study through its settings, in their order.
struct CostCurve {
    std::string method;
    bool counts_iterations = false;  // the settings are iterations; otherwise a resolution
    std::vector<Priced> points;
    real grain = 1;  // settings between entries are multiples of it: cells that keep a grid's proportions whole; 0: any number
};

/// The study's table, written by `weir cost` in `folder` or in its folder csv. Settings that failed are left out. Throws BadInput.
std::vector<CostCurve> read_cost_table(const Study& study, const std::filesystem::path& folder);

/// Between two measured settings: with the resolution error and time go by powers; with iterations the error falls by a constant factor
/// each, and time grows by a constant. Nothing beyond what was measured, nor across a step of the error that two entries do not tell about.
std::optional<Priced> predict(const CostCurve& curve, real setting);

struct Budget {
    double seconds = 0.016;   // of computing: for a frame, or for a step where the study prices steps
    real error = 0;           // at most
    double frame = 1.0 / 60;  // simulated seconds of a frame
};

struct Choice {
    const CostCurve* curve = nullptr;
    Priced at{};
    double seconds = 0;    // of computing, as the budget counts
    bool measured = true;  // an entry of the table; otherwise read between two
};

/// Computing time of a frame or a step. A frame takes at least one step.
double seconds_of(const Priced& p, Price price, const Budget& budget);

struct Recommendation {
    std::optional<Choice> take;   // the cheapest that is good enough and within the budget
    std::vector<Choice> nearest;  // where there is none: the most accurate within the budget, the cheapest that is good enough
};
Recommendation recommend(const std::vector<CostCurve>& curves, Price price, const Budget& budget);

/// "16ms", "0.5 s", "2%", "0.02". Throws BadInput.
double parse_seconds(const std::string& text);
real parse_error(const std::string& text);

struct PlanOptions {
    std::string name{};  // of a case with a study
    std::string budget = "16ms", error{}, frame = "16.666667ms";
    std::filesystem::path tables = "results/cost";
    Size size = Size::ci;
};
/// Runs `weir plan` and returns its exit code: 1 where no setting reaches what is asked.
int plan_command(const PlanOptions& options);

}  // namespace weir::validation
