// Particles between two states of rest: what a minute at rest changes, and a liquid that becomes a gas and a liquid again.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace weir::validation {
namespace {

/// Mean of an integral over [from, to] seconds.
real mean_between(const RunRecord& run, const char* integral, real from, real to) {
    const Curve c = run.series(integral);
    real sum = 0, seen = 0;
    for (std::size_t i = 0; i < c.size(); ++i)
        if (c.x[i] >= from && c.x[i] <= to) sum += c.y[i], seen += 1;
    return sum / seen;
}
/// What the last second has more than the second one.
real change_at_rest(const RunRecord& run, const char* integral) {
    return mean_between(run, integral, run.time - 1, run.time) - mean_between(run, integral, 1, 2);
}

constexpr int boxes = 4;  // along each axis: each of 16 then expects a sixteenth of the particles

/// Smallest number of particles in any of boxes^2 parts of the container, over the mean of all: 1 is spread evenly, 0 leaves a part empty.
real emptiest_part(const FieldSet& fields) {
    const FieldView& x = needed_field(fields, "particles", "position");
    const GridView& g = fields.grid;
    std::vector<real> inside(static_cast<std::size_t>(boxes * boxes), 0.0);
    for (std::size_t i = 0; i < x.data[0].size(); ++i) {
        std::size_t at = 0;
        for (std::size_t a = 0; a < 2; ++a) {
            const auto k = static_cast<int>(boxes * (x.data[a][i] - g.origin[a]) / (g.spacing[a] * g.cells[a]));
            at = at * boxes + static_cast<std::size_t>(std::clamp(k, 0, boxes - 1));
        }
        inside[at] += 1;
    }
    return *std::min_element(inside.begin(), inside.end()) * boxes * boxes / static_cast<real>(x.data[0].size());
}

/// Standard deviation over mean of the density of all particles that are farther than `skin` spacings below the highest one.
real density_spread(const FieldSet& fields) {
    constexpr real skin = 3;  // a kernel that reaches out of the liquid sees less of it
    const auto& y = needed_field(fields, "particles", "position").data[1];
    const auto& rho = needed_field(fields, "particles", "density").data[0];
    std::vector<real> heights(y.begin(), y.end());
    std::sort(heights.begin(), heights.end());
    if (heights.empty()) return std::nan("");
    const real surface = heights[heights.size() * 98 / 100];  // a drop in flight is no surface
    real sum = 0, squares = 0, seen = 0;
    for (std::size_t i = 0; i < y.size(); ++i)
        if (y[i] < surface - skin * fields.grid.spacing[1]) sum += rho[i], squares += rho[i] * rho[i], seen += 1;
    const real mean = sum / seen;
    return std::sqrt(std::max<real>(0, squares / seen - mean * mean)) / mean;
}

}  // namespace

std::vector<Metric> phase_metrics() {
    return {
        {.name = "rest.density_drift",
         .unit = "",
         .doc = "|change of mean density| from the second second to the last, over the density at rest.",
         .measure = [](const RunRecord& run,
                       const Reference&) { return std::abs(change_at_rest(run, "mean_density")) / run.scene->number("fluid.density"); }},
        {.name = "rest.height_drift",
         .unit = "",
         .doc = "|change of the surface's height| (twice that of the mean height) from the second second to the last, in spacings.",
         .measure = [](const RunRecord& run,
                       const Reference&) { return 2 * std::abs(change_at_rest(run, "mean_height")) / run.fields.grid.spacing[1]; }},
        {.name = "gas.emptiest_part",
         .unit = "",
         .doc = "Particles in the emptiest of 4 x 4 parts of the container over the mean, when they are spread best; 1 is spread evenly.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const Curve c = run.series("gas.emptiest_part");
                 return *std::max_element(c.y.begin(), c.y.end());
             },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return emptiest_part(fields); }},
        {.name = "liquid.density_spread",
         .unit = "",
         .doc = "Standard deviation of density over its mean, without the three spacings below the surface.",
         .measure = [](const RunRecord& run, const Reference&) { return density_spread(run.fields); }},
    };
}

}  // namespace weir::validation
