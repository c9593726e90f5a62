// Particles that boil by heat: at what temperature, and the gas that they become.
#include "thermo/ambient.hpp"
#include "thermo/scene_substance.hpp"
#include "thermo/substance.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace weir::validation {
namespace {

constexpr int strips_of_gas = 8;

bool all_vapour(const FieldSet& fields) {
    const auto& share = needed_field(fields, "particles", "vapour").data[0];
    return std::all_of(share.begin(), share.end(), [](real v) { return v == 1; });
}

/// Mass in each of so many strips along an axis over the mean of all. A particle is spread over the gas's mean spacing, and what of that
/// is beyond the walls counts inside: counted as points, a lattice's rows would beat with the strips.
std::vector<real> gas_profile(const FieldSet& fields, std::size_t axis) {
    const auto& x = needed_field(fields, "particles", "position").data;
    const GridView& g = fields.grid;
    real volume = 1;
    for (std::size_t a = 0; a < x.size() && a < static_cast<std::size_t>(g.dim); ++a) volume *= g.spacing[a] * g.cells[a];
    const real count = static_cast<real>(x[0].size()), length = g.spacing[axis] * g.cells[axis];
    const real half = 0.5 * std::pow(volume / count, 1.0 / g.dim) / length;
    std::vector<real> mass(strips_of_gas, 0.0);
    for (const real place : x[axis]) {
        const real at = (place - g.origin[axis]) / length;
        for (int s = 0; s < strips_of_gas; ++s) {
            const real lo = s > 0 ? real(s) / strips_of_gas : -1, hi = s + 1 < strips_of_gas ? (s + real(1)) / strips_of_gas : 2;
            mass[static_cast<std::size_t>(s)] += std::max<real>(0, std::min(hi, at + half) - std::max(lo, at - half)) / (2 * half);
        }
    }
    for (real& m : mass) m *= strips_of_gas / count;
    return mass;
}

/// How far the density of the middle half along every axis is from that of all, where all is vapour.
real gas_mean_error(const FieldSet& fields) {
    if (!all_vapour(fields)) return not_applicable;
    real worst = 0;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(fields.grid.dim); ++axis) {
        const auto profile = gas_profile(fields, axis);
        real middle = 0;
        for (int s = strips_of_gas / 4; s < strips_of_gas - strips_of_gas / 4; ++s) middle += profile[static_cast<std::size_t>(s)];
        worst = std::max(worst, std::abs(middle / (strips_of_gas / 2) - 1));
    }
    return worst;
}

real gas_profile_error(const FieldSet& fields) {
    if (!all_vapour(fields)) return not_applicable;
    real worst = 0;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(fields.grid.dim); ++axis)
        for (const real m : gas_profile(fields, axis)) worst = std::max(worst, std::abs(m - 1));
    return worst;
}

/// At the last moment at which it has a value.
real last_known(const RunRecord& run, const char* series) {
    const Curve c = run.series(series);
    real last = not_applicable;
    for (const real y : c.y)
        if (!std::isnan(y)) last = y;
    return last;
}

/// Largest |T − T_sat(p(t) + ρ g d)| of what is partly vapour, and T − T_sat of what is liquid, d below the level of the liquid at rest;
/// while no more than a hundredth of all has become vapour, before bubbles stir it.
real boiling_error(const FieldSet& fields, const scene::Scene& scene, real t) {
    constexpr real first_hundredth = 0.01;
    const auto& y = needed_field(fields, "particles", "position").data[1];
    const auto& T = needed_field(fields, "particles", "temperature").data[0];
    const auto& share = needed_field(fields, "particles", "vapour").data[0];
    const GridView& g = fields.grid;
    real all = 0;
    for (const real s : share) all += s;
    const auto count = static_cast<real>(y.size());
    if (all > first_hundredth * count) return not_applicable;
    const real level = count * g.spacing[1] / g.cells[0];
    const real weight = scene.number("fluid.density") * std::abs(scene.root().numbers("effects.gravity.g").at(1));
    const auto water = thermo::water();
    const real pressure = thermo::Ambient(scene).pressure(t);
    real worst = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        const real depth = std::max<real>(0, level - (y[i] - g.origin[1]));
        const real above = T[i] - water->temperature(thermo::Boundary::saturation, pressure + weight * depth);
        worst = std::max(worst, share[i] > 0 ? std::abs(above) : above);
    }
    return worst;
}

real largest_known(const RunRecord& run, const char* series) {
    real worst = 0;
    for (const real y : run.series(series).y)
        if (!std::isnan(y)) worst = std::max(worst, y);
    return worst;
}

/// A line of the substance between two temperatures.
Curve line_of(const thermo::Substance& substance, thermo::Boundary boundary, const char* label, real from, real to) {
    constexpr int pieces = 60;
    Curve curve{.label = label, .dashed = true};
    for (int i = 0; i <= pieces; ++i) {
        const real T = from + (to - from) * i / pieces;
        curve.x.push_back(T), curve.y.push_back(substance.pressure(boundary, T));
    }
    return curve;
}

/// Where the warmest particle of a run has been among the states of its substance.
Panel path_in_diagram(const RunRecord& run, const Reference&) {
    Panel panel{.title = "The run among the states", .x = {"T [K]"}, .y = {"p [Pa]", true}};
    const auto substance = thermo::substance_of(*run.scene);
    const thermo::Ambient ambient(*run.scene);
    constexpr real below = 20, above = 160;  // the triple point, so much of the lines: water from 90 Pa to 0.7 MPa [K]
    if (const auto triple = substance->triple(); triple && substance->critical()) {
        panel.curves.push_back(line_of(*substance, thermo::Boundary::sublimation, "sublimation", triple->T - below, triple->T));
        panel.curves.push_back(line_of(*substance, thermo::Boundary::saturation, "saturation", triple->T,
                                       std::min(triple->T + above, substance->critical()->T)));
    }
    const Curve T = run.series("warmest");
    Curve path{.label = "warmest", .x = T.y};
    for (const real t : T.x) path.y.push_back(ambient.pressure(t));
    panel.curves.push_back(std::move(path));
    return panel;
}

}  // namespace

std::vector<Metric> boiling_metrics() {
    return {
        {.name = "gas.mean_error",
         .unit = "",
         .doc = "How far the density of the container's middle half, along every axis, is from the mean at the last moment at which all is "
                "vapour, relative.",
         .measure = [](const RunRecord& run, const Reference&) { return last_known(run, "gas.mean_error"); },
         .figure = path_in_diagram,
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return gas_mean_error(fields); }},
        {.name = "gas.profile_error",
         .unit = "",
         .doc =
             "Largest departure of the density of any of 8 strips along any axis from the mean at the last moment at which all is vapour, "
             "relative.",
         .measure = [](const RunRecord& run, const Reference&) { return last_known(run, "gas.profile_error"); },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return gas_profile_error(fields); }},
        {.name = "boiling.temperature_error",
         .unit = "K",
         .doc = "Largest |T - T_sat(p + rho g d)| of any boiling particle, and T - T_sat of any liquid one, d below the level at rest "
                "and p the pressure of the moment, until a hundredth of all is vapour.",
         .measure = [](const RunRecord& run, const Reference&) { return largest_known(run, "boiling.temperature_error"); },
         .figure = path_in_diagram,
         .observe = [](const FieldSet& fields, const scene::Scene& scene, real t) { return boiling_error(fields, scene, t); }},
    };
}

}  // namespace weir::validation
