// weir run --measure: what a case or a study would measure of this run, by the same functions.
#pragma once
#include "sim/simulation.hpp"
#include "validation/harness/runner.hpp"

#include <map>
#include <string>
#include <vector>

namespace weir::app {

class Measured {
public:
    /// Throws BadInput where a metric is unknown, or where run or reference lacks what it needs. A reference's data stand beside the scene,
    /// in its folder data.
    Measured(Simulation& simulation, std::vector<std::string> metrics, const std::string& reference);
    void on_step(const StepReport& report, double seconds) { watch_.on_step(report, seconds); }
    /// By name, with the computing time of a step and of a simulated second as studies count them: without the first step.
    const std::map<std::string, double>& values();
    /// A line each, for the end of a run.
    std::string text();

private:
    std::vector<std::string> metrics_;
    validation::Reference reference_;
    validation::RunWatch watch_;
    std::map<std::string, double> values_{};
};

}  // namespace weir::app
