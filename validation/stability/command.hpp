// `weir stability`: where each solver breaks.
#pragma once
#include "sim/registry.hpp"
#include "validation/report/pins.hpp"
#include "validation/stability/limit.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace weir::validation {

struct StabilityOptions {
    std::vector<std::string> names{};  // cases by name, or folders
    bool all = false;                  // every case with a stability.toml
    bool list = false;                 // axes of each, nothing is run
    std::string axis{};                // only this one
    std::filesystem::path compare{};   // published folder: only whether each limit is where it was, by a run at either end
    bool guaranteed_only = false;      // check only the guaranteed ranges: one run per axis
    Size size = Size::ci;
    std::int64_t steps = 0;                       // with guaranteed_only: runs end after so many, and nothing is judged; 0: whole runs
    std::filesystem::path out = "out/stability";  // <case>.json and limits.csv
    std::filesystem::path publish{};              // folder of the published page; empty: not published
    bool quiet = false;
};

/// How near the bisection comes: stable and unstable differ by less than this factor.
inline real bisection_factor(Size size) { return size == Size::ci ? 1.5 : 1.1; }

/// One line an axis and method: the last stable value, theory, what broke first, where and when, the guaranteed range.
std::string limits_table(const StressStudy& study, const std::vector<Limit>& limits);
nlohmann::json limits_json(const StressStudy& study, const std::vector<Limit>& limits);
/// Each axis' ends, what its run is hard by, the step and time at which it breaks.
Numbers numbers_of(const std::vector<Limit>& limits);
/// Whether the limits are where they were published, by a run at either end of each; where they were found with other rounding, or none
/// are published, whether their guaranteed ranges pass; so too, at ci size, of slow axes. The exit code of the command.
int compare_limits(const std::vector<StressStudy>& studies, Size size, const std::filesystem::path& published, const Solvers& solvers);
std::string limits_markdown(const nlohmann::json& study);
/// Open targets beyond the guaranteed ranges of all studies; empty where there are none.
std::string open_targets_markdown(const std::vector<nlohmann::json>& studies);
/// One table of all studies' limits, by solver.
std::string all_limits_markdown(const std::vector<nlohmann::json>& studies);

nlohmann::json map_json(const StressMap& map, const std::vector<std::vector<std::optional<Break>>>& cells, double seconds);
/// The maps of a study for the terminal: a dot where nothing broke, a letter for what broke first.
std::string maps_text(const nlohmann::json& study);

/// Runs the command and returns its exit code: 1 where a guaranteed range is not reached, an axis proves to be another
/// than it says, or published limits are older than the code. Throws BadInput
/// before anything is run.
int stability_command(const StabilityOptions& options, const Solvers& solvers = sim::registry());

}  // namespace weir::validation
