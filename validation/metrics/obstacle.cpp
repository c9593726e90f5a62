// Moving bodies in smoke: nothing inside them, and the fluid's momentum answers to the forces on it.
#include "geometry/solids.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Largest |smoke| in cells that lie wholly inside a body (deeper than half a diagonal).
template <int D>
real smoke_inside(const FieldSet& fields, const scene::Scene& scene, real t) {
    geometry::Solids<D> solids(scene.root().tables("solids"));
    solids.set_time(t);
    const FieldView* smoke = fields.find("", "smoke");
    if (!smoke) throw BadInput("the solver shows no field \"smoke\"");
    real diagonal = 0;
    for (int d = 0; d < D; ++d) diagonal += std::pow(fields.grid.spacing[static_cast<std::size_t>(d)], 2);
    real worst = 0;
    for_each_sample(fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) {
        Vec<D> at;
        for (int d = 0; d < D; ++d) at[d] = x[d];
        if (solids.distance(at) < -std::sqrt(diagonal) / 2) worst = std::max(worst, std::abs(smoke->data[0][i]));
    });
    return worst;
}

/// P(t) - P(0) + I(t) for motion along x: the fluid's momentum, and the impulse that its pressure has given to the bodies. Nothing else
/// may change the momentum where x is periodic.
Curve missing_impulse(const RunRecord& run) {
    Curve missing = run.series("momentum_x");
    const Curve impulse = run.series("solid_impulse_x");
    const real first = missing.y.at(0);
    for (std::size_t i = 0; i < missing.size(); ++i) missing.y[i] += impulse.y[i] - first;
    return missing;
}

Panel impulse_panel(const RunRecord& run) {
    Curve momentum = run.series("momentum_x"), impulse = run.series("solid_impulse_x"), missing = missing_impulse(run);
    for (auto& y : impulse.y) y = -y;
    momentum.label = "momentum of the fluid", impulse.label = "impulse from the body", missing.label = "difference";
    return {.title = "Momentum and impulse", .x = {"t [s]"}, .y = {"[kg/s]"}, .curves = {momentum, impulse, missing}};
}

}  // namespace

std::vector<Metric> obstacle_metrics() {
    return {
        {.name = "impulse.balance_error",
         .unit = "",
         .doc = "Largest change of the fluid's x momentum that no impulse from bodies accounts for, over the largest impulse.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 return largest_magnitude(missing_impulse(run)) / largest_magnitude(run.series("solid_impulse_x"));
             },
         .figure = [](const RunRecord& run, const Reference&) { return impulse_panel(run); }},
        {.name = "smoke.budget_error",
         .unit = "",
         .doc = "Largest difference between the smoke that is held and what was there, less what was removed inside bodies, with what was "
                "continued where they had been; over what was there.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 Curve missing = run.series("total_smoke");
                 const Curve removed = run.series("smoke_removed"), continued = run.series("smoke_continued");
                 const real first = missing.y.at(0);
                 for (std::size_t i = 0; i < missing.size(); ++i) missing.y[i] += removed.y[i] - continued.y[i] - first;
                 return largest_magnitude(missing) / first;
             }},
        {.name = "smoke.inside_solids",
         .unit = "",
         .doc = "Largest amount of smoke at any step in cells wholly inside a body.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const Curve s = run.series("smoke.inside_solids");
                 return *std::max_element(s.y.begin(), s.y.end());
             },
         .observe = [](const FieldSet& fields, const scene::Scene& scene,
                       real t) { return scene.dim() == 2 ? smoke_inside<2>(fields, scene, t) : smoke_inside<3>(fields, scene, t); }},
    };
}

}  // namespace weir::validation
