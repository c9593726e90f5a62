// The exact series of a probe or an integral: a reference's fields along its position, or a formula of time.
#pragma once
#include "scene/scene.hpp"
#include "validation/harness/reference.hpp"
#include "validation/uncertainty/recorded_run.hpp"

#include <optional>
#include <string>

namespace weir::validation {

/// The exact counterpart of a recorded series, over the same interval of time: of points, lines and gauges the field at their position; of
/// kinetic_energy and momentum_x, momentum_y the integral of the velocity over the domain. None where the reference lacks the field.
std::optional<RecordedSeries> exact_series(const RecordedSeries& series, const scene::Scene& scene, const Reference& reference);

/// A curve of a reference under the name of a recorded series, within the same interval.
RecordedSeries series_from_curve(const RecordedSeries& series, const Curve& curve);

/// A formula of t [s] under the name of a recorded series, over the same interval. Throws scene::BadFormula.
RecordedSeries series_from_formula(const RecordedSeries& series, const std::string& formula);

}  // namespace weir::validation
