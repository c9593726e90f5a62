// What can stand around a liquid, as lines of a scene (a box of 1 x 1.5 [x 1] m); and what of it the double reference takes.
#pragma once
#include "particles/domain.hpp"
#include "particles/reference.hpp"

#include <fmt/core.h>

#include <string>
#include <vector>

namespace weir::test {

/// "x, y" in 2D, "x, y, z" in 3D.
template <int D>
std::string list(double x, double y, double z) {
    return D == 2 ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, {}]", x, y, z);
}

template <int D>
std::string periodic_sides() {
    const std::string both = "sides.{0}_min = {{ kind = \"periodic\" }}\nsides.{0}_max = {{ kind = \"periodic\" }}\n";
    return fmt::format(fmt::runtime(both), "x") + (D == 3 ? fmt::format(fmt::runtime(both), "z") : "") +
           "initial.velocity = { name = \"constant\", value = " + list<D>(3, 0, 1) + " }\n";
}
template <int D>
std::string open_sides() {
    return "sides.x_max = { kind = \"open\" }\ninitial.velocity = { name = \"constant\", value = " + list<D>(3, 0, 0) + " }\n";
}

/// All of them, each by itself.
template <int D>
std::vector<std::string> surroundings() {
    return {periodic_sides<D>(), open_sides<D>()};
}

/// Periods, for a reference.
template <int D>
particles::Point periods(const particles::Domain<D>& domain) {
    return domain.frame().period;
}

/// From b to a along the shortest way.
template <int D>
Vec<D> apart(const particles::Domain<D>& domain, const Vec<D>& a, const Vec<D>& b) {
    Vec<D> d = a - b;
    for (int k = 0; k < D; ++k)
        if (domain.sides.periodic(k)) d[k] -= (domain.hi[k] - domain.lo[k]) * std::round(d[k] / (domain.hi[k] - domain.lo[k]));
    return d;
}

}  // namespace weir::test
