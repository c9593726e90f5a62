// Numbers out of a curve: zero crossings, frequency, decay, power laws.
#pragma once
#include "validation/harness/curve.hpp"

namespace weir::validation {

/// Times at which a curve crosses zero, on straight lines between its points.
std::vector<real> zero_crossings(const Curve& c);
/// Angular frequency from the first to the last zero crossing; NaN with fewer than three.
real frequency(const Curve& c);
/// The largest |y| between consecutive zero crossings, on the parabola through three points.
Curve extrema(const Curve& c);
/// Rate gamma of the best exp(-gamma t) through the extrema (least squares in their logarithm); NaN with fewer than two.
real decay(const Curve& c);
/// Exponent of the best y = C x^p over points with from <= x <= to (least squares in logarithms).
real power_law(const Curve& c, real from, real to);
/// The largest |y|; NaN if any y is.
real largest_magnitude(const Curve& c);
/// The largest y of a curve that is nowhere negative; NaN if any is.
real largest(const Curve& c);
/// Slope of the least-squares line.
real slope(const std::vector<real>& x, const std::vector<real>& y);

}  // namespace weir::validation
