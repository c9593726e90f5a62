// What moves a result besides the grid: the time step, the seeds of markers, chaos, and keys that no grid refines. A few further runs on
// the coarsest grids of a ladder.
#pragma once
#include "validation/uncertainty/method_study.hpp"

namespace weir::validation {

/// A run with the step halved and runs with other seeds on the coarsest grid add to the bands: their differences, reduced by the ratio of
/// the cells. A twin of the second coarsest run, changed by one part in a million, gives the time after which the flow is chaotic. Keys of
/// the model that are not refined (iterations, sound speed) are doubled once.
void study_other_influences(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store,
                            const Tell& tell);

/// Refuses values at single times and times of events after the flow has become chaotic; gives means over windows the band of the spread of
/// their six parts.
void refuse_after_chaos(MethodStudy& study);

/// First time at which the two series, averaged over 1/30 of their length, differ by 5% of the range of the first; no value: never.
std::optional<real> time_of_parting(const Curve& one, const Curve& twin);

}  // namespace weir::validation
