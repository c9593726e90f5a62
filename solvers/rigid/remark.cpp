#include "rigid/remark.hpp"

#include "rigid/bodies.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

/// Density of the lightest solid foams [kg/m³]: scenes with denser bodies probably mean water.
constexpr real foam = 20;

template <int D>
std::string remark(const scene::Scene& scene) {
    const Bodies<D> bodies(scene);
    const auto sinks = [](const Body<D>& body) { return body.density() >= foam; };
    const auto heavy = std::count_if(bodies.all().begin(), bodies.all().end(), sinks);
    if (heavy == 0) return "";
    const Body<D>& first = *std::find_if(bodies.all().begin(), bodies.all().end(), sinks);
    return "fluid.density is not given; the default is " + scene::number_text(scene.number("fluid.density")) +
           " kg/m^3, the density of air, and body \"" + first.name + "\" of " + scene::number_text(std::round(first.density())) +
           " kg/m^3 sinks in it" + (heavy > 1 ? ", and " + std::to_string(heavy - 1) + (heavy > 2 ? " others" : " other") : "") +
           "; for water: fluid = { density = 1000.0 }";
}

}  // namespace

std::string remark_on_density(const scene::Scene& scene) {
    if (!scene.has("bodies") || scene.root().tables("bodies").empty() || scene.root().place("fluid.density").column != 0) return "";
    return scene.dim() == 2 ? remark<2>(scene) : remark<3>(scene);
}

}  // namespace weir::rigid
