// Runs the scenes of a case and takes its measurements.
#pragma once
#include "scene/solver_kind.hpp"
#include "validation/harness/case.hpp"
#include "validation/harness/metric.hpp"
#include "validation/harness/verdict.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// Those that scenes may name; sim::registry() but in tests.
using Solvers = std::vector<scene::SolverKind>;

struct RunOptions {
    std::filesystem::path frames{};                            // folder of this run's .pvd; empty: none is written
    real time_limit = infinity;                                // wall seconds
    std::optional<std::int64_t> steps{};                       // the most; absent: to the scene's end
    std::vector<const Metric*> observers{};                    // metrics that watch every step
    std::function<void(const RunRecord&)> at_start = nullptr;  // sees the initial state; may throw BadInput before a step is spent
};

/// What metrics see of a run, kept while somebody's loop drives it: the state at the start, then every step.
class RunWatch {
public:
    /// The simulation must outlive the watch. `metrics` that observe are asked at the start and after every step.
    RunWatch(Simulation& simulation, const std::vector<const Metric*>& metrics);
    void on_step(const StepReport& report, double seconds);
    /// As the run stands now: fields, probes and passes are taken up to date.
    RunRecord& record();

private:
    void remember(const StepReport& report, double seconds);
    Simulation* simulation_;
    std::vector<const Metric*> observers_{};
    RunRecord record_{};
};

/// Runs a scene to its end. A NumericalFailure or an exceeded time limit ends the run and stands in `failure`.
RunRecord run_scene(scene::Scene scene, const RunOptions& options, const Solvers& solvers);

/// The reference of a scene by name; throws BadInput naming those known. An empty name gives an empty reference.
Reference make_reference(const std::string& name, const scene::Scene& scene, const std::filesystem::path& case_folder);

/// Run `i` of a variant, measured. Never throws for what a run does wrong: that stands in the result and fails its claims.
RunResult run_and_measure(const Case& c, const Variant& variant, std::size_t i, const std::filesystem::path& frames,
                          const Solvers& solvers);

/// Called before each run: "taylor_green maccormack 64".
using Progress = std::function<void(const std::string&)>;

/// All runs of a case, judged. Frames go to out/<case>/<variant>/<value>/.
CaseResult validate(const Case& c, const std::filesystem::path& out, const Solvers& solvers, const Progress& progress = nullptr);

/// What can be known without running: every scene of the case reads, every reference exists. Throws BadInput.
void check_case(const Case& c, const Solvers& solvers);

}  // namespace weir::validation
