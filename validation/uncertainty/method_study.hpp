// The ladder of one method: its runs, what they cost, and the uncertainty of every asked quantity on every grid.
#pragma once
#include "validation/harness/band.hpp"
#include "validation/uncertainty/asked.hpp"
#include "validation/uncertainty/ladder.hpp"
#include "validation/uncertainty/run_store.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// What limits a study.
struct Limits {
    double frame = 1.0 / 60;   // simulated seconds of a frame
    double budget = infinity;  // computing seconds of a frame
    double time_limit = 120;   // computing seconds of one run
    int rungs = 4;             // grids of a ladder
    bool checks = true;        // halved step, seeds, twin, keys that are not refined
};

/// A quantity on the grids of a ladder, coarse to fine.
struct QuantityStudy {
    Asked asked{};
    std::vector<Value> values{};                          // of each grid
    std::optional<Band> band{};                           // of the finest three
    real step = 0, seeds = 0;                             // differences on the coarsest grid: of a halved time step, of the markers' seeds
    real finer = 1;                                       // cell of the finest grid over that of the coarsest, which reduces both
    real width = std::numeric_limits<real>::quiet_NaN();  // of the finest grid: band + finer (step + seeds)
    std::vector<real> error{};                            // bound of each grid's error: distance to the finest + width
    std::string refused{};                                // why nothing is recommended
    std::vector<std::string> not_refined{};               // "scheme.iterations = 4: doubled, the value moves by 1.2 mm"

    const Value& finest() const { return values.back(); }
};

struct GridRun {
    Grid grid{};
    RecordedRun run{};
};

struct MethodStudy {
    Method method{};
    std::string solver_fails{};    // why there is no study
    std::vector<GridRun> grids{};  // coarse to fine
    std::vector<QuantityStudy> quantities{};
    std::string left_out{};               // grids, and why
    std::optional<real> chaotic_after{};  // [s]
    std::string twin{};                   // what the twin run changed; empty: none was compared
    double estimated = 0;                 // computing seconds of the ladder, from its two coarsest grids
    double spent = 0;                     // of all grids of the ladder
    int next = 0;                         // number of the next finer grid
    double next_seconds = 0;              // computing time of that grid, estimated

    double seconds_per_frame(std::size_t grid, double frame) const { return grids[grid].run.seconds_per_frame(frame); }
};

using Tell = std::function<void(const std::string&)>;

/// The grid of this number for a ladder of which `runs` exist: its steps shrink with its cells, from the mean step of the coarsest run.
Grid next_grid(const Ladder& ladder, const std::vector<GridRun>& runs, int number);

/// Runs the ladder of a method. `wishes`: one for each quantity, or none. Throws BadInput where a quantity is unknown.
MethodStudy study_method(const scene::Scene& scene, const Method& method, const std::vector<Asked>& asked, const std::vector<Wish>& wishes,
                         const Limits& limits, RunStore& store, const Solvers& solvers, const Tell& tell);

/// Removes the finest grid if its run did not end within `time_limit` computing seconds and three coarser ones exist. A grid whose run
/// fails numerically stays: no coarser grid is recommended then.
bool leave_out_unfinished(MethodStudy& study, double time_limit);

/// Width, bounds and refusals of the quantities for the grids that were run.
/// A band wider than widest_band of the scale is refused, unless its wish is an absolute value, which decides then.
void assess(MethodStudy& study, const std::vector<Asked>& asked, const std::vector<Wish>& wishes = {});

/// Grids that would be finer than this many times the finest one are not estimated.
inline constexpr real farthest = 100;

/// Bands wider than this part of the scale are refused.
inline constexpr real widest_band = 0.2;

/// "1.7 mm": the value in a unit of a suitable size, with as many digits as `to` has significance (two digits of it).
std::string text_with_unit(real value, const std::string& unit, real to);

/// "0.33 s", "52 s", "12 min", "3 h".
std::string seconds_text(double seconds);

}  // namespace weir::validation
