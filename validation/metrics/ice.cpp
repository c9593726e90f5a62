// Ice afloat among particles: how deep it lies, and where the water stands before, while and after it melts.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace weir::validation {
namespace {

using Column = std::pair<int, int>;  // along x and, in 3D, z

const std::vector<std::span<const real>>& positions(const FieldSet& fields) { return needed_field(fields, "particles", "position").data; }
std::span<const real> shares(const FieldSet& fields) { return needed_field(fields, "particles", "liquid").data[0]; }
bool frozen(real liquid) { return liquid < 0.5; }

Column column_of(const FieldSet& fields, std::size_t i) {
    const auto& x = positions(fields);
    const auto cell = [&](std::size_t a) {
        return a < x.size() ? static_cast<int>((x[a][i] - fields.grid.origin[a]) / fields.grid.spacing[a]) : 0;
    };
    return {cell(0), cell(2)};
}

/// Mean over the columns of cells that are further than this from ice of the highest particle in each, and half a spacing.
constexpr int far_from_ice = 4;
real level(const FieldSet& fields, const scene::Scene&, real) {
    const auto& x = positions(fields);
    const auto liquid = shares(fields);
    std::set<Column> near;
    for (std::size_t i = 0; i < liquid.size(); ++i) {
        if (!frozen(liquid[i])) continue;
        const auto [a, b] = column_of(fields, i);
        for (int da = -far_from_ice; da <= far_from_ice; ++da)
            for (int db = -far_from_ice; db <= far_from_ice; ++db) near.insert({a + da, b + db});
    }
    std::map<Column, real> highest;
    for (std::size_t i = 0; i < liquid.size(); ++i) {
        const Column at = column_of(fields, i);
        if (near.count(at)) continue;
        auto [place, first] = highest.try_emplace(at, x[1][i]);
        place->second = std::max(place->second, x[1][i]);
    }
    real sum = 0;
    for (const auto& [at, y] : highest) sum += y;
    return highest.empty() ? not_applicable : sum / static_cast<real>(highest.size()) + 0.5 * fields.grid.spacing[1];
}

/// How dense the solid is, over the liquid.
real density_ratio(const scene::Scene& scene) { return scene.number("substance.solid.density") / scene.number("substance.liquid.density"); }

/// How much too deep ice lies, in spacings of the liquid: the share of its volume below the level at which the whole mass would stand as
/// water, less the one that Archimedes asks for, times its height. Each of its particles is a slice as thick as a spacing of the solid.
real draft(const FieldSet& fields, const scene::Scene& scene, real) {
    const auto& x = positions(fields);
    const auto liquid = shares(fields);
    const GridView& g = fields.grid;
    const real ratio = density_ratio(scene), slice = g.spacing[0] / std::pow(ratio, 1.0 / g.dim);
    real floor = g.cells[0];
    if (g.dim == 3) floor *= g.cells[2];
    const real water = g.origin[1] + static_cast<real>(liquid.size()) * g.spacing[0] / floor;
    real under = 0, count = 0, lowest = infinity, highest = -infinity;
    for (std::size_t i = 0; i < liquid.size(); ++i) {
        if (!frozen(liquid[i])) continue;
        const real y = x[1][i];
        under += std::clamp((water - (y - slice / 2)) / slice, 0.0, 1.0), count += 1;
        lowest = std::min(lowest, y), highest = std::max(highest, y);
    }
    return count > 0 ? (under / count - ratio) * (highest - lowest + slice) / g.spacing[0] : not_applicable;
}

/// Mean of what was observed from `begin` to `end`, where there was any.
real mean_of(const Curve& curve, real begin, real end) {
    real sum = 0, count = 0;
    for (std::size_t i = 0; i < curve.size(); ++i)
        if (curve.x[i] >= begin && curve.x[i] <= end && std::isfinite(curve.y[i])) sum += curve.y[i], count += 1;
    return sum / count;
}

/// The heater's start and end: before it the ice floats, and has come to rest in the second half of that; a while after it, it has melted.
/// Without a heater it floats to the end.
real heated_from(const RunRecord& run) {
    const auto& heaters = run.scene->root().tables("heaters");
    return heaters.empty() ? run.time : heaters[0].number("start");
}
real heated_to(const RunRecord& run) { return run.scene->root().tables("heaters").at(0).number("end"); }

real draft_error(const RunRecord& run, const Reference&) {
    return std::abs(mean_of(run.series("ice.draft_error"), heated_from(run) / 2, heated_from(run)));
}

real level_change(const RunRecord& run, const Reference&) {
    for (const real liquid : shares(run.fields))
        if (frozen(liquid)) throw BadInput("ice is left at the end: ice.level_change needs it melted");
    const Curve curve = run.series("ice.level_change");
    const real before = mean_of(curve, heated_from(run) / 2, heated_from(run));
    const real after = mean_of(curve, 0.5 * (heated_to(run) + run.time), run.time);
    return std::abs(after - before) / run.fields.grid.spacing[0];
}

Panel level_panel(const RunRecord& run, const Reference&) {
    Curve curve = run.series("ice.level_change");
    curve.label = "water beside the ice";
    for (real& y : curve.y) y *= 1000;
    return {.title = "The level while ice melts", .x = {"t [s]"}, .y = {"y [mm]"}, .curves = {curve}};
}

}  // namespace

std::vector<Metric> ice_metrics() {
    return {
        {.name = "ice.draft_error",
         .unit = "",
         .doc = "How much deeper or higher than by Archimedes ice lies before it is heated, in spacings of particles.",
         .measure = draft_error,
         .observe = draft},
        {.name = "ice.level_change",
         .unit = "",
         .doc = "How far the water's level beside ice is from the one after all has melted, in spacings of particles.",
         .measure = level_change,
         .figure = level_panel,
         .observe = level},
    };
}

}  // namespace weir::validation
