// What moves a result besides the grid: the time step, the seeds of markers, chaos, and keys that no grid refines. A few further runs on
// the coarsest grids of a ladder.
#pragma once
#include "validation/uncertainty/method_study.hpp"

namespace weir::validation {

/// On the coarsest grid: a run with the step halved, runs with other seeds of markers, and keys of the model that no grid refines
/// (iterations, sound speed) doubled once.
void study_coarsest_grid(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store,
                         const Tell& tell);

/// A twin of the second finest run (of the finest where there are few), changed by one part in a million, gives the time after which the
/// flow is chaotic.
void study_chaos(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store, const Tell& tell);

/// Refuses values at single times and times of events after the flow has become chaotic; gives means over windows the band of the spread of
/// their six parts. Returns whether a value was refused.
bool refuse_after_chaos(MethodStudy& study);

/// First time at which the two series, averaged over 1/30 of their length, differ by 5% of the range of the first; no value: never, or the
/// range is below `least`.
std::optional<real> time_of_parting(const Curve& one, const Curve& twin, real least = 0);

}  // namespace weir::validation
