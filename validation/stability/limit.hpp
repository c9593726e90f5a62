// How far a solver can be pushed along one axis: a key of its scene, raised until something that must hold does not. Read from
// cases/<name>/stability.toml.
#pragma once
#include "validation/harness/case.hpp"
#include "validation/harness/runner.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// What must hold after every step, of an integral or a number of the step report. That numbers are finite, that solves reach their
/// tolerance and that the time step does not vanish is watched always.
struct Invariant {
    enum class Test { at_most, at_least, drift, never_rises } test = Test::at_most;
    std::string series{};
    bool times_value = false;  // at_most, at_least: the bound is for a value of 1 of the key, and grows with it
    real bound = 0;  // at_most, at_least: of the value; drift: |value - first| / |first|; never_rises: a step, relative to the largest
    std::string why{};
    /// "kinetic_energy <= 3"
    std::string text() const;
};

/// One axis of one method.
struct Stress {
    std::string name{};  // of the axis: "cfl"
    std::string method{};
    std::string key{};
    real low = 0, high = 0;  // both positive; the axis is logarithmic
    std::string hard_because{};
    std::optional<real> theory{};  // the limit that theory gives
    std::string theory_source{};
    std::optional<real> floor{};  // the least that must be stable
    std::string floor_why{};
    std::int64_t steps = 0;  // a run ends here if its scene has not ended before
    Variant base{};
    std::vector<Invariant> watch{};
};

struct StressStudy {
    std::string name{};
    std::filesystem::path folder{};
    std::string question{};
    std::vector<Stress> stresses{};
};

const std::vector<scene::Key>& stability_keys();
/// Throws scene::BadScene with every problem in the file.
StressStudy read_stability(const std::filesystem::path& folder, Size size);
StressStudy parse_stability(std::string_view text, const std::string& file, const std::filesystem::path& folder, Size size);
std::vector<std::filesystem::path> find_stability(const std::filesystem::path& root);

/// What broke first in a run, where and when.
struct Break {
    std::string what{};
    std::int64_t step = 0;
    real time = 0;
};

struct Limit {
    Stress stress{};
    std::optional<real> last_stable{};     // absent: not even the low end is
    std::optional<real> first_unstable{};  // absent: the high end is still stable
    Break broke{};                         // at first_unstable
    int runs = 0;
    double seconds = 0;
    bool guarded() const { return !stress.floor || (last_stable && *last_stable >= *stress.floor); }
};

/// Runs the scene with the key at `value`; nothing broke: no value.
std::optional<Break> push(const Stress& stress, real value, const Solvers& solvers);

/// Bisects in the logarithm until stable and unstable differ by less than `factor`.
Limit find_limit(const Stress& stress, real factor, const Solvers& solvers);

/// Whether the floor holds, by one run at it.
Limit check_floor(const Stress& stress, const Solvers& solvers);

/// For tests: the bisection alone, on any predicate.
Limit bisect(const Stress& stress, real factor, const std::function<std::optional<Break>(real)>& push);

}  // namespace weir::validation
