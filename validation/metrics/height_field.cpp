// Columns of water: discharge along a river, where it jumps, crests and run-up.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/samples.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Highest surface of columns that are deeper than a thousandth of the deepest, above y = 0, where these scenes have their still water.
real crest_height(const FieldSet& fields, const scene::Scene&, real) {
    const FieldView *depth = fields.find("depth"), *surface = fields.find("surface");
    if (!depth || !surface) throw BadInput("the solver shows no fields \"depth\" and \"surface\"");
    const auto &h = depth->data[0], &s = surface->data[0];
    const real film = 1e-3 * *std::max_element(h.begin(), h.end());
    real highest = -infinity;
    for (std::size_t c = 0; c < h.size(); ++c)
        if (h[c] > film) highest = std::max(highest, s[c]);
    return highest;
}

real highest_of(const Curve& series) { return *std::max_element(series.y.begin(), series.y.end()); }

Panel depth_panel(const RunRecord& run, const Reference& ref) {
    Curve ours{.label = "weir", .x = {}, .y = {}}, exact{.label = ref.source, .x = {}, .y = {}};
    const auto& h = run.field("depth").data[0];
    for_each_sample(run.fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) {
        ours.x.push_back(x[0]), ours.y.push_back(h[i]);
        exact.x.push_back(x[0]), exact.y.push_back(ref.scalar("depth")(x, run.time));
    });
    exact.dashed = true;
    return {.title = "Depth at the end", .x = {"x [m]"}, .y = {"h [m]"}, .curves = {exact, ours}};
}

real discharge_error(const RunRecord& run, const Reference& ref) {
    const auto &h = run.field("depth").data[0], &u = run.field("velocity").data[0];
    const real q = ref.number("discharge");
    real worst = 0;
    for (std::size_t c = 0; c < h.size(); ++c) worst = std::max(worst, std::abs(h[c] * u[c] - q) / q);
    return worst;
}

/// Where the last shooting column meets tranquil water.
real jump_error(const RunRecord& run, const Reference& ref) {
    const auto &h = run.field("depth").data[0], &u = run.field("velocity").data[0];
    const real g = -run.scene->effect("gravity")->numbers("g").at(1);
    const GridView& grid = run.fields.grid;
    real at = std::nan("");
    for (std::size_t c = 0; c + 1 < h.size(); ++c)
        if (u[c] * u[c] > g * h[c] && u[c + 1] * u[c + 1] <= g * h[c + 1])
            at = grid.origin[0] + grid.spacing[0] * (static_cast<real>(c) + 1);
    return std::abs(at - ref.number("jump"));
}

}  // namespace

std::vector<Metric> height_field_metrics() {
    return {
        {.name = "discharge.error",
         .unit = "",
         .doc = "Largest difference of depth times velocity to the reference's discharge in any column at the end, over that.",
         .measure = discharge_error,
         .figure = depth_panel},
        {.name = "jump.error",
         .unit = "m",
         .doc = "Distance of the place where shooting water becomes tranquil to the reference's.",
         .measure = jump_error},
        {.name = "crest.loss",
         .unit = "",
         .doc = "How much lower the highest surface above y = 0 is at the end than at the start, over that.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const Curve s = run.series("crest.loss");
                 return 1 - s.y.back() / s.y.front();
             },
         .figure = depth_panel,
         .observe = crest_height},
        {.name = "runup.error",
         .unit = "",
         .doc = "Relative difference of the highest surface above y = 0 of the run to the reference's run-up.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return std::abs(highest_of(run.series("runup.error")) / ref.number("run_up") - 1); },
         .observe = crest_height},
    };
}

}  // namespace weir::validation
