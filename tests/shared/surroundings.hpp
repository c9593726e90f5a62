// What can stand around a liquid, as lines of a scene (a box of 1 x 1.5 [x 1] m).
#pragma once
#include "core/solver.hpp"
#include "particles/state/domain.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

namespace weir::test {

/// The effects that a solver says it has built.
inline std::vector<std::string> built(const Solver& solver) {
    std::vector<std::string> names;
    for (const EffectPlan& plan : solver.effects()) names.push_back(plan.name);
    std::sort(names.begin(), names.end());
    return names;
}

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

/// Every shape there is; `more` is added to each solid.
template <int D>
std::string solids_at_rest(const std::string& more = "") {
    const auto ball = fmt::format("shape = \"sphere\", centre = {}, radius = 0.15", list<D>(0.25, 0.35, 0.4));
    const auto block = fmt::format("{{ shape = \"box\", min = {}, max = {} }}", list<D>(0.6, 0.1, 0.25), list<D>(0.85, 0.5, 1));
    const auto hole =
        fmt::format("{{ shape = \"capsule\", from = {}, to = {}, radius = 0.1 }}", list<D>(0.5, 0.3, 0.5), list<D>(0.9, 0.2, 0.6));
    const auto pillar =
        fmt::format("{{ shape = \"cylinder\", from = {}, to = {}, radius = 0.08 }}", list<D>(0.4, 0.7, 0.4), list<D>(0.6, 0.8, 0.8));
    const auto slope = fmt::format("{{ shape = \"plane\", point = {}, normal = {} }}", list<D>(0.95, 0, 0), list<D>(-1, 0.1, 0));
    return fmt::format(
        "solids = [{{ {}{} }}, {{ shape = \"difference\", from = {}, minus = [{}]{} }}, {{ shape = \"union\", of = [{}, {}]{} }}, "
        "{{ shape = \"wave\", level = 0.06, amplitude = 0.03, wavelength = 0.8{} }}]\n",
        ball, more, block, hole, more, pillar, slope, more, more);
}
/// A ball that goes up and a bar that turns.
template <int D>
std::string moving_solids(const std::string& more = "") {
    const auto ball =
        fmt::format("{{ shape = \"sphere\", centre = {}, radius = 0.2, motion = {{ kind = \"constant\", velocity = {} }}{} }}",
                    list<D>(0.25, 0.3, 0.4), list<D>(0.5, 2, 0.25), more);
    const auto bar = fmt::format("{{ shape = \"box\", min = {}, max = {}, motion = {{ kind = \"rotation\", rate = 3 }}{} }}",
                                 list<D>(0.6, 0.4, 0.25), list<D>(0.9, 0.5, 0.75), more);
    return fmt::format("solids = [{}, {}]\n", ball, bar);
}

/// A jet along the box above the liquid, and a drain in a corner.
template <int D>
std::string jet_and_drain() {
    return fmt::format(
        "emitters = [{{ shape = \"box\", min = {}, max = {}, velocity = {} }}]\nsinks = [{{ shape = \"box\", min = {}, max = {} }}]\n",
        list<D>(0.1, 1.15, 0.25), list<D>(0.2, 1.4, 0.75), list<D>(8, 0, 0), list<D>(0.7, 0, 0), list<D>(1, 0.4, 1));
}

/// All of them, each by itself. solid: what is said of solids.
template <int D>
std::vector<std::string> surroundings(const std::string& solid = "") {
    return {periodic_sides<D>(), open_sides<D>(), solids_at_rest<D>(solid), moving_solids<D>(solid), jet_and_drain<D>()};
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
