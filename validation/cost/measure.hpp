// One point of a work-precision diagram: a method at one setting, its error and its price.
#pragma once
#include "validation/cost/study.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
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
    std::optional<std::string> failure{};  // why there is no error or no price, as the table says it
    bool on_front = false;                 // nothing else in the study is both cheaper and more accurate
    int threads = 0;                       // that a step took: fewer than there are where a setting has little work
    std::string device{};                  // where its backend is a device: which
    std::string device_kind{};             // GPU, CPU, accelerator

    double price(Price by) const { return by == Price::second ? seconds_per_second : ms_per_step; }
    /// "pbf-opencl 144 (on CPU)": that OpenCL ran on a processor is part of the name.
    std::string name() const;
    /// The same without the setting.
    std::string label() const { return device_kind.empty() ? method : method + " (on " + device_kind + ")"; }
    /// It could not even begin: no such device here, or bad input.
    bool was_run() const { return !failure || !failure->starts_with(not_run); }
    static constexpr std::string_view not_run = "not run: ";
};

/// Computing seconds and simulated seconds of a run, without its first step (first touches of memory) where there are others.
struct Timing {
    double computing = 0, simulated = 0;
    std::int64_t steps = 0;
    double ms_per_step() const { return steps > 0 ? 1e3 * computing / static_cast<double>(steps) : 0; }
    double seconds_per_second() const { return simulated > 0 ? computing / simulated : 0; }
};
Timing timing_of(const RunRecord& record);
/// Prices of a setting's repeats: medians, so that one disturbed run says nothing; of an even number the faster of the middle two.
void take_times(CostPoint& point, std::vector<Timing> runs);

struct StudyResult {
    Study study;
    std::string source{};  // the reference's citation
    std::string unit{};    // of the error
    int threads = 1;
    std::vector<CostPoint> points{};
};

struct MeasureOptions {
    int repeats = 3;  // of runs that take less than enough_seconds together
    double enough_seconds = 2;
    double least_seconds = 0.3;  // runs that are over sooner are repeated up to most_repeats times: a median of milliseconds needs many
    int most_repeats = 21;
    double time_limit = 120;  // of one run; beyond it is a failure that stays in the table
};

/// Runs everything; never throws for what a run does wrong. `progress` is called before each run with the point's name.
StudyResult measure_study(const Study& study, const MeasureOptions& options, const Solvers& solvers,
                          const std::function<void(const std::string&)>& progress = nullptr);

/// Errors, further metrics and bytes of every point that ran on the processor: what does not depend on how fast it is.
std::map<std::string, real> numbers_of(const StudyResult& result);

/// Marks the points that no other one dominates (Pareto), by what the reference can tell: of errors below what it is known to, and of
/// errors that differ by less than 5%, the cheaper point wins.
void mark_front(std::vector<CostPoint>& points, const Study& study);

}  // namespace weir::validation
