// Root of a monotone function in an interval.
#pragma once
#include "core/types.hpp"

namespace weir::thermo {

/// f(x) returns the value and its derivative. Newton's method within a bracket that each value narrows (Press et al., Numerical Recipes,
/// 9.4); ends when x changes only by rounding. f(lo) and f(hi) must differ in sign, or one be zero.
template <class F>
real root_between(real lo, real hi, F&& f) {
    const bool rising = f(hi).first > 0;
    real x = 0.5 * (lo + hi);
    for (int i = 0; i < 200; ++i) {  // bisection alone narrows the bracket to adjacent numbers in fewer than 110 iterations
        const auto [value, slope] = f(x);
        if (value == 0) return x;
        (rising == (value > 0) ? hi : lo) = x;
        real next = x - value / slope;
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        if (std::abs(next - x) <= std::numeric_limits<real>::epsilon() * std::abs(x)) return next;
        x = next;
    }
    return x;
}

}  // namespace weir::thermo
