// Quantities that a user names: SERIES[.STATISTIC][@WHEN]. SERIES is a probe, with the column where it has several (right.height), an
// integral (kinetic_energy) or a quantity of the steps (cfl). Statistics are over the window WHEN: a time (@2.5), or an interval with one
// or two ends (@0.8.., @..2, @0.8..2).
#pragma once
#include "core/types.hpp"
#include "validation/harness/curve.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

struct RunRecord;

enum class Statistic { end, max, min, mean, rms, range, drift, change, time_of_max, time_of_min, time_of, period, curve, picture };

/// An interval of simulated time [s]; first == last: one time.
struct Window {
    real first = -infinity, last = infinity;
    bool one_time() const { return first == last; }
};

/// The `crossing`-th time at which a series rises above the level, or falls below it.
struct Crossing {
    bool above = true;
    real level = 0;
    int number = 1;
};

struct NamedQuantity {
    std::string text{};       // as the user wrote it
    std::string series{};     // "right.height"; the field of a picture
    std::string statistic{};  // as written, "" for the end
    Statistic kind = Statistic::end;
    Crossing crossing{};
    Window when{};
    bool is_time() const {
        return kind == Statistic::time_of_max || kind == Statistic::time_of_min || kind == Statistic::time_of || kind == Statistic::period;
    }
    /// The samples of the series at the asked times, one number otherwise.
    bool is_vector() const { return kind == Statistic::curve || kind == Statistic::picture; }
    /// A value at one time, or the time of an event: what chaos makes unpredictable.
    bool is_point() const { return kind != Statistic::mean && kind != Statistic::rms; }
};

/// Throws BadInput, with what is allowed, where the text is no name of a quantity. Whether a run has such a series is not checked.
NamedQuantity parse_quantity(std::string_view text);

/// The part of the series within the window; values at its ends are interpolated. Empty where the series does not cover a finite end. A
/// time after the last row by less than the distance of two rows counts as that of the last row.
Curve within(const Curve& series, const Window& window);

/// The statistic of a series within the window; NaN where it is not known: no such event, a value that is not finite, or a window that the
/// series does not cover. `mean` and `rms` are time averages (trapezoidal rule); `drift` and `change` are relative to |first|; the time of
/// a maximum is the vertex of the parabola through the largest sample and its neighbours; `period` is the mean time between rises above
/// the mean. Not for curves and pictures.
real statistic_of(const Curve& series, const NamedQuantity& quantity);

/// The series at these times [s], interpolated linearly; NaN outside.
std::vector<real> sampled(const Curve& series, const std::vector<real>& times);

/// The unit of a quantity whose series has the unit `unit`.
std::string unit_of(const NamedQuantity& quantity, const std::string& unit);

}  // namespace weir::validation
