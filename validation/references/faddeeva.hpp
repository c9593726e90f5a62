// The Faddeeva function w(z) = exp(-z^2) erfc(-i z) for complex z; GSL has erfc for real arguments only.
#pragma once
#include "core/types.hpp"

#include <complex>

namespace weir::validation {

using Complex = std::complex<real>;

/// Rational expansion of Weideman 1994 (SIAM J. Numer. Anal. 31, 1497-1518) in the upper half plane, with the reflection
/// w(z) = 2 exp(-z^2) - w(-z) below it. Relative error under 1e-12 for Im z >= 0.
Complex faddeeva(Complex z);

/// exp(z^2) erfc(z) = w(i z).
Complex scaled_erfc(Complex z);

}  // namespace weir::validation
