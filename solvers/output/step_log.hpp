// Reports of every step of a run, in two files beside run.json: steps.csv, which depends only on the scene, and timings.csv, the time of
// each step and of each of its passes. Both are flushed after each step.
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
    /// Starts new files.
    void begin();
    /// Keeps the rows up to step `last` of an earlier run's files.
    void resume(std::int64_t last);
    /// Adds step number `step`, which ended at t; `passes`: accumulated by the solver, `seconds`: of the whole step. Throws OutputError.
    void add(std::int64_t step, real t, const StepReport& report, const Passes& passes, double seconds);
    /// All steps so far, as one JSON object: their number, the minimum, mean and maximum of each column, total and maximum milliseconds of
    /// each pass.
    std::string summary() const;

private:
    struct TimedPass {
        std::string name;
        double before = 0;  // its seconds at the previous step
    };
    std::size_t place_of(std::size_t at, const std::string& pass);

    StepRows steps_, timings_;
    std::vector<TimedPass> passes_;  // in the order of their columns
    std::vector<real> row_;
};

}  // namespace weir::output
