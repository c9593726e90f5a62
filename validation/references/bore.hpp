// A dam that breaks over still water sends a bore into it: Stoker 1957, section 10.8.
#pragma once
#include "scene/scene.hpp"

namespace weir::validation {

/// Gravity towards lower y [m/s²].
real gravity_down(const scene::Scene& scene);

/// The zero of an increasing or decreasing f between a and b.
template <class F>
real root_between(F&& f, real a, real b) {
    const bool rises = f(b) > f(a);
    for (int n = 0; n < 200; ++n) {
        const real mid = 0.5 * (a + b);
        ((f(mid) > 0) == rises ? b : a) = mid;
    }
    return 0.5 * (a + b);
}

/// Position of a dam, and depths at its left and right [m].
struct Dam {
    real x = 0, left = 0, right = 0;
};
/// Liquid as boxes: the first ends at the dam, a second lies before it.
Dam dam_of(const scene::Scene& scene);

/// The bore that a dam sends into still water at its right.
struct Bore {
    real h = 0, u = 0, speed = 0;  // depth and velocity behind it, and its own velocity [m, m/s]
    Bore(const Dam& dam, real g);
    /// Depth behind the bore that a wall sends back.
    real reflected(real g) const;
};

}  // namespace weir::validation
