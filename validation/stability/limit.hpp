// How far a solver can be pushed along one axis: a key of its scene, raised until something that must hold does not. Read from
// cases/<name>/stability.toml.
#pragma once
#include "validation/harness/case.hpp"
#include "validation/harness/runner.hpp"
#include "validation/stability/preconditions.hpp"

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
    real power = 0;  // at_most, at_least: the bound is for a value of 1, and grows with this power of the value
    real bound = 0;  // at_most, at_least: of the value; drift: |value - first| / |first|; never_rises: a step, relative to the largest
    std::string why{};
    /// "kinetic_energy <= 3"
    std::string text() const;
};

/// What an axis is for. limit: pushed until something breaks. units: all its values are dimensionally similar, so that a break is an
/// absolute number in the code. guard: it ends where a guard takes over, or refuses.
enum class AxisKind { limit, units, guard };
std::string_view name(AxisKind kind);

/// One axis of one method. Its value sets `key`, and stands wherever a change of the scene says <a> (a times the value), <a^p> (a times
/// its power p) or <a^p round> (that, as a whole number).
struct Stress {
    std::string name{};  // of the axis: "cfl"
    std::string method{};
    AxisKind kind = AxisKind::limit;
    std::string solver{};    // as the scene names it; known once its scene has been read
    std::string key{};       // may be empty where changes hold the value
    real low = 0, high = 0;  // both positive; the axis is logarithmic
    std::string hard_because{};
    std::optional<real> theory{};  // the limit that theory gives
    std::string theory_source{};
    std::optional<real> guaranteed{};  // the value up to which runs must be stable
    std::string guaranteed_why{};
    std::optional<real> open_target{};  // above `guaranteed`, not met: listed, and an error once it is met
    std::string not_reached{};          // why
    bool nested = false;                // a run at one value contains those at all lesser ones: the end is tried first
    bool slow = false;                  // a comparison at ci size checks the guaranteed range only
    std::int64_t steps = 0;             // a run ends here if its scene has not ended before
    bool cut = false;                   // before the preconditions hold: preconditions at the end are not checked
    Variant base{};
    std::vector<Invariant> watch{};
    std::vector<Precondition> preconditions{};  // of each value
    std::string unbroken{};                     // limit: why nothing can break however far it is pushed
};

/// One axis of a two-axis map: a key and its values, as they stand in a scene.
struct MapAxis {
    std::string key{};
    std::string label{};
    std::vector<std::string> values{};
};

/// Every pair of two keys' values, each run until something breaks.
struct StressMap {
    Stress stress{};  // whose name, method, changes, invariants and steps hold for all runs
    MapAxis x{}, y{};
};

struct StressStudy {
    std::string name{};
    std::filesystem::path folder{};
    std::string question{};
    std::vector<Stress> stresses{};
    std::vector<StressMap> maps{};
};

const std::vector<scene::Key>& stability_keys();
/// Throws scene::BadScene with every problem in the file.
StressStudy read_stability(const std::filesystem::path& folder, Size size);
StressStudy parse_stability(std::string_view text, const std::string& file, const std::filesystem::path& folder, Size size);
std::vector<std::filesystem::path> find_stability(const std::filesystem::path& root);

/// What broke first in a run, where and when.
struct Break {
    std::string what{};
    std::string kind{};  // the invariant without the number; what maps colour by
    std::int64_t step = 0;
    real time = 0;
};

struct Limit {
    Stress stress{};
    bool climbed = false;                        // the whole axis was tried, not only its guaranteed range
    std::optional<real> last_stable{};           // absent: not even the low end is
    std::optional<real> first_unstable{};        // absent: the high end is still stable
    Break broke{};                               // at first_unstable
    std::vector<MeasuredValue> preconditions{};  // at last_stable, or where nothing is stable at the low end
    int runs = 0;
    double seconds = 0;
    bool guarded() const { return !stress.guaranteed || (last_stable && *last_stable >= *stress.guaranteed); }
    /// What speaks against the axis itself: it ends before anything breaks without a reason, it breaks though that was ruled out,
    /// another kind of axis breaks, or what is listed as not reached holds. Empty where nothing does.
    std::string doubt() const;
    bool passes() const { return guarded() && doubt().empty(); }
};

/// The configuration with the axis at `value`. Throws BadInput where a placeholder cannot be read.
Variant pushed_to(const Stress& stress, real value);

/// Runs the configuration until something breaks, its scene ends or so many steps are taken; nothing broke: no value. A state that the
/// solver refuses to start from is a break at step 0; a scene that does not read is BadInput, and so is a run that is not as hard as its
/// axis says. measured: its preconditions.
std::optional<Break> run_watched(const Variant& variant, const Stress& stress, real value, const Solvers& solvers,
                                 std::vector<MeasuredValue>* measured = nullptr);

/// The same with the axis at `value`.
std::optional<Break> push(const Stress& stress, real value, const Solvers& solvers, std::vector<MeasuredValue>* measured = nullptr);

/// Climbs the axis until something breaks, then bisects in the logarithm until stable and unstable differ by less than `factor`.
Limit find_limit(const Stress& stress, real factor, const Solvers& solvers);

/// Checks the guaranteed range by one run at its end.
Limit check_guaranteed(const Stress& stress, const Solvers& solvers);

/// The two ends of a limit that was found before, each run once: without what does not hold there now. Either may be absent.
Limit recheck(const Stress& stress, std::optional<real> last_stable, std::optional<real> first_unstable, const Solvers& solvers);

/// What each run of a map came to: [x][y].
std::vector<std::vector<std::optional<Break>>> fill_map(const StressMap& map, const Solvers& solvers,
                                                        const std::function<void(std::size_t)>& progress = nullptr);

/// For tests: the bisection alone, on any predicate.
Limit bisect(const Stress& stress, real factor, const std::function<std::optional<Break>(real)>& push);

}  // namespace weir::validation
