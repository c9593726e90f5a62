// One point of a work-precision diagram: a method at one setting, its error and its price.
#pragma once
#include "validation/cost/study.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

struct CostPoint {
    std::string method{};
    std::string setting{};  // "64", the sweep's value as text; empty without a sweep
    real error = not_applicable;
    std::map<std::string, real> also{};
    double seconds_per_second = 0;  // computing time a simulated second: median over the repeats
    double ms_per_step = 0;
    double spread = 0;  // (largest - least) / median of the repeats
    double others = 0;  // cores that other programs used meanwhile
    int repeats = 0;
    std::int64_t steps = 0;
    std::size_t bytes = 0;                 // held by the solver
    std::optional<std::string> failure{};  // why there is no error or no price
    bool on_front = false;                 // nothing else in the study is both cheaper and more accurate

    double price(Price by) const { return by == Price::second ? seconds_per_second : ms_per_step; }
    std::string name() const { return setting.empty() ? method : method.empty() ? setting : method + " " + setting; }
};

struct StudyResult {
    Study study;
    std::string source{};  // the reference's citation
    int threads = 1;
    std::vector<CostPoint> points{};
};

struct MeasureOptions {
    int repeats = 3;  // of runs that take less than enough_seconds together
    double enough_seconds = 8;
    double time_limit = 120;  // of one run; beyond it is a failure that stays in the table
};

/// Runs everything; never throws for what a run does wrong. `progress` is called before each run with the point's name.
StudyResult measure_study(const Study& study, const MeasureOptions& options, const Solvers& solvers,
                          const std::function<void(const std::string&)>& progress = nullptr);

/// Marks the points that no other one dominates (Pareto).
void mark_front(std::vector<CostPoint>& points, Price price);

}  // namespace weir::validation
