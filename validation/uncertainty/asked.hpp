// What a user asks of a scene: quantities, and how accurately they should be known.
#pragma once
#include "validation/harness/named_quantity.hpp"
#include "validation/uncertainty/recorded_run.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// "5%" of the scale of the quantity, or an absolute value: "5mm", "0.02", "1kPa".
struct Wish {
    std::string text{};
    real value = infinity;  // in the unit of the quantity, or a part of its scale
    bool relative = false;
    std::string unit{};
};
/// Throws BadInput.
Wish parse_wish(const std::string& text);

struct Asked {
    NamedQuantity quantity{};
    bool is_metric = false;  // a registered metric, by name
};
/// Each a metric or a quantity. Throws BadInput.
std::vector<Asked> parse_asked(const std::vector<std::string>& of);

/// The field of a picture is sampled by line probes at the centres of a lattice of at most 64 x 64 or 16 x 16 x 16 points.
std::vector<scene::Override> picture_probes(const std::vector<Asked>& asked, const scene::Scene& scene);

/// A quantity of one run: its samples, one where it is a number; or why it is not known.
struct Value {
    std::vector<real> samples{};
    std::string unit{};
    std::string unknown{};
    real scale = 0;          // what a percentage refers to
    std::string scale_of{};  // "its range", "its value"
};
/// `number`: of the quantity among those asked.
Value value_of(const RecordedRun& run, const Asked& asked, std::size_t number);
/// The series behind a quantity within its window at 100 times, for comparing whole series; empty for metrics and pictures.
std::vector<real> whole_series(const RecordedRun& run, const Asked& asked);

/// The largest magnitude of all series of this unit in a run. Below round_off times that, a series is round-off.
real largest_of_unit(const RecordedRun& run, const std::string& unit);
inline constexpr real round_off = 1e-9;
/// A series whose range is below this part of its size does not vary: pressure solves end at such tolerances.
inline constexpr real no_variation = 1e-6;

/// The wish in the unit of the quantity. Throws BadInput where the units do not fit.
real absolute(const Wish& wish, const Value& value);

}  // namespace weir::validation
