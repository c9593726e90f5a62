// Scalar volumes for rays: a lattice of floats, sampled trilinearly, and where a ray meets a box.
#pragma once
#include "core/types.hpp"
#include "sim/sampling.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace weir::picture {

struct Ray {
    Vec<3> origin, direction;  // direction of length 1
    Vec<3> at(real s) const { return origin + s * direction; }
};

struct Box {
    Vec<3> min, max;
    /// Where the ray is inside, as (enter, leave) with enter >= 0.
    std::optional<std::pair<real, real>> span(const Ray& ray) const {
        real enter = 0, leave = infinity;
        for (int a = 0; a < 3; ++a) {
            const real inverse = 1 / ray.direction[a];
            const real s0 = (min[a] - ray.origin[a]) * inverse, s1 = (max[a] - ray.origin[a]) * inverse;
            enter = std::max(enter, std::min(s0, s1));
            leave = std::min(leave, std::max(s0, s1));
        }
        if (!(enter < leave)) return std::nullopt;
        return std::pair{enter, leave};
    }
};

/// Zero outside its box.
struct Volume {
    sim::Lattice lattice;
    Box box;
    std::vector<real> values;
    real at(const Vec<3>& x) const {
        for (int a = 0; a < 3; ++a)
            if (x[a] < box.min[a] || x[a] > box.max[a]) return 0;
        return sim::sample(values, lattice, x);
    }
    Vec<3> gradient(const Vec<3>& x, real eps) const {
        Vec<3> g;
        for (int a = 0; a < 3; ++a) g[a] = (at(x + eps * Vec<3>::unit(a)) - at(x - eps * Vec<3>::unit(a))) / (2 * eps);
        return g;
    }
};

}  // namespace weir::picture
