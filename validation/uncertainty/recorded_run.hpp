// One run of a scene, kept: the series of all its probes and integrals, its computing time, and why it failed.
#pragma once
#include "scene/scene.hpp"
#include "validation/harness/curve.hpp"
#include "validation/harness/named_quantity.hpp"
#include "validation/harness/runner.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// A series of a run: "right.height" of a probe, "kinetic_energy".
struct RecordedSeries {
    std::string name{}, unit{};
    bool integral = false;
    Curve curve{};
};

struct RecordedRun {
    std::vector<int> cells{};
    std::vector<RecordedSeries> series{};
    std::map<std::string, real> measured{};  // metrics that were asked for
    double seconds = 0;                      // of computing, on one thread
    double ms_per_step = 0, seconds_per_second = 0;
    std::int64_t steps = 0;
    real mean_dt = 0, end = 0;             // [s]
    std::optional<std::string> failure{};  // why its numbers must not be used
    std::vector<std::string> warnings{};   // of the balance, then of the run
    bool balanced = true;                  // the balance has no warning

    /// Computing time per frame [s] of `frame` simulated seconds; a frame takes at least one step.
    double seconds_per_frame(double frame) const;
};

/// The scene to its end on one thread. What goes wrong stands in `failure`; `metrics` are registered metrics that require no reference.
RecordedRun record_run(const scene::Scene& scene, const std::vector<std::string>& metrics, double time_limit, const Solvers& solvers);

/// The series that a run of this scene records, without values. Throws BadInput where the scene cannot start.
std::vector<RecordedSeries> series_at_start(const scene::Scene& scene, const Solvers& solvers);

/// The series of that name; "right" names the only column of a probe. Throws BadInput naming the available series.
const RecordedSeries& series_named(const std::vector<RecordedSeries>& series, std::string_view name);

/// JSON of a run, and back. Throws BadInput where the text is none.
std::string to_json(const RecordedRun& run);
RecordedRun run_from_json(const std::string& text);

}  // namespace weir::validation
