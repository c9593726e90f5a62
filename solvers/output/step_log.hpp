// What every step of a run reported, in two files beside run.json: steps.csv, which depends on the scene alone, and timings.csv, the time
// of each step and of each of its passes. Both are flushed after each step.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "output/step_rows.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

class StepLog {
public:
    static constexpr const char* steps_file = "steps.csv";
    static constexpr const char* timings_file = "timings.csv";

    explicit StepLog(const std::filesystem::path& folder);
    /// New files.
    void begin();
    /// Keeps the rows up to step `last` of an earlier run's files.
    void resume(std::int64_t last);
    /// Step number `step`, which ended at t; `passes` as they accumulate in the solver, `seconds` of the whole step. Throws OutputError.
    void add(std::int64_t step, real t, const StepReport& report, const Passes& passes, double seconds);
    /// All steps so far, one JSON object: how many, of each column the least, mean and greatest value, of each pass all and most
    /// milliseconds.
    std::string summary() const;

private:
    struct TimedPass {
        std::string name;
        double before = 0;  // its seconds when the last step was added
    };
    std::size_t place_of(std::size_t at, const std::string& pass);

    StepRows steps_, timings_;
    std::vector<TimedPass> passes_;  // in the order of their columns
    std::vector<real> row_;
};

}  // namespace weir::output
