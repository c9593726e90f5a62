// Which setting to take: what the tables of `weir cost` measured, read between their entries, against a budget of time and of error.
#pragma once
#include "validation/cost/study.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// What a table says of one setting, or what is read between two of them.
struct Priced {
    real setting = 0;  // cells along x, iterations; 0 where the method has no sweep
    real error = 0;
    double seconds_per_second = 0, ms_per_step = 0;
    std::int64_t steps = 0;
    int threads = 1;        // that it was measured on
    std::size_t index = 0;  // of the setting in the method's sweep

    double seconds() const { return 1e-3 * ms_per_step * static_cast<double>(steps); }  // of computing, all of the run
};

/// One method of a study through its settings, in their order.
struct CostCurve {
    std::string method;
    bool counts = false;  // the settings are a number of iterations or of entries; otherwise a resolution
    std::vector<Priced> points;
    real grain = 1;  // settings between entries are multiples of it: cells that keep a grid's proportions whole; 0: any number
};

/// The study's table, written by `weir cost` in `folder` or in its folder csv. Left out are settings that failed, that the study no longer
/// has, and that cannot run on this machine (no such device or vector unit). Throws BadInput.
std::vector<CostCurve> read_cost_table(const Study& study, const std::filesystem::path& folder);
/// The size at which that table was measured.
Size size_of_table(const std::string& study, const std::filesystem::path& folder);

/// Between two measured settings: with the resolution error and time go by powers; with iterations the error falls by a constant factor
/// each, and time grows by a constant. Nothing beyond what was measured, nor across a step of the error that two entries do not tell about.
std::optional<Priced> predict(const CostCurve& curve, real setting);

struct Budget {
    double seconds = infinity;  // of computing: for a frame, or for a step where the study prices steps
    real error = infinity;      // at most
    double frame = 1.0 / 60;    // simulated seconds of a frame
    real known_to = 0;          // how well the study's reference is known: errors below it are alike

    real told(real e) const { return std::max(e, known_to); }
};

struct Choice {
    const CostCurve* curve = nullptr;
    Priced at{};
    double seconds = 0;  // of computing, as the budget counts
};

/// Computing time of a frame or a step. A frame takes at least one step.
double seconds_of(const Priced& p, Price price, const Budget& budget);

struct Recommendation {
    std::optional<Choice> take;     // measured: the cheapest that is good enough and within the budget; without an error the most accurate
    std::vector<Choice> nearest;    // where there is none, measured: the most accurate within the budget, the cheapest that is good enough
    std::optional<Choice> between;  // read between two entries: good enough, and cheaper than the recommended one; not measured
};
Recommendation recommend(const std::vector<CostCurve>& curves, Price price, const Budget& budget);
/// Every entry that recommend() can name for some budget and some error: those than which none is both cheaper and as accurate.
std::vector<Choice> recommendable(const std::vector<CostCurve>& curves, Price price, const Budget& budget);

/// "16ms", "0.5 s", "2%", "0.02". Throws BadInput.
double parse_seconds(const std::string& text);
real parse_error(const std::string& text);

}  // namespace weir::validation
