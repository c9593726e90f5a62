// Numerical uncertainty of a quantity from three grids. The observed order of accuracy is clipped to what the method can have, and the
// larger of the two differences between the grids counts, so that one difference which is small by accident cannot shrink the band. Roache
// 1998 (the grid convergence index); Oberkampf & Roy 2010, section 8.4 (clipped orders). Measured coverage: cases/error_bars.
#pragma once
#include "core/types.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// What three grids say about their convergence.
enum class Convergence {
    asymptotic,   // the observed order lies between 1/2 and the formal order + 1/2
    faster,       // the observed order is above: the finest difference is small by accident
    slow,         // the differences do not shrink as grids refine
    oscillating,  // the differences have opposite signs
    equal         // the grids do not differ
};

struct Band {
    real width = 0;                      // U: the error of the finest grid is at most U
    real observed_order = 0, order = 0;  // p, and q, to which it is clipped
    Convergence convergence = Convergence::asymptotic;
};

/// The value of a quantity on one grid of width h: one sample, or several (a curve, a picture).
struct GridValue {
    real h = 0;
    std::vector<real> value{};
};

/// Root mean square of f - g; |f - g| for one sample.
real distance(const std::vector<real>& f, const std::vector<real>& g);
real size_of(const std::vector<real>& f);

/// Observed order p of differences a = |f1 - f2| and b = |f2 - f3| of grids h1 < h2 < h3: the root of
/// b/a = (h2/h1)^p ((h3/h2)^p - 1) / ((h2/h1)^p - 1), clipped to [-4, 12].
real observed_order(real a, real b, real h1, real h2, real h3);

/// U = F C h1^q with q = p clipped to [1/2, formal order], or min(1, formal order) where the differences oscillate,
/// C = max(a / (h2^q - h1^q), b / (h3^q - h2^q)), and F = 1.5 where the grids are asymptotic, else 2. For several samples |.| is the root
/// mean square, and differences oscillate where their inner product is negative. Values from coarse to fine, at least three; the last three
/// count. Throws BadInput for fewer.
Band band(const std::vector<GridValue>& grids, real formal_order);

/// Bounds of the errors of all grids: the distance to the finest, and its width.
std::vector<real> error_bounds(const std::vector<GridValue>& grids, real width);

/// The formal order of a solver's results: of mac 2 (1 with semi-Lagrangian advection), of waves 2, of height fields 3/2 (limiters,
/// shores), of free surfaces and particles 1.
real formal_order(std::string_view solver, std::string_view advection);

std::string_view words_of(Convergence convergence);

}  // namespace weir::validation
