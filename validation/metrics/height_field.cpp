// Columns of water: discharge along a river, where it jumps, crests and run-up.
#include "validation/harness/fitting.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Highest surface of columns that are deeper than a thousandth of the deepest, above y = 0, where these scenes have their still water.
real crest_height(const FieldSet& fields, const scene::Scene&, real) {
    const FieldView *depth = fields.find("", "depth"), *surface = fields.find("", "surface");
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
    const auto& h = needed_field(run.fields, "", "depth").data[0];
    for_each_sample(run.fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) {
        ours.x.push_back(x[0]), ours.y.push_back(h[i]);
        exact.x.push_back(x[0]), exact.y.push_back(ref.scalar("depth")(x, run.time));
    });
    exact.dashed = true;
    return {.title = "Depth at the end", .x = {"x [m]"}, .y = {"h [m]"}, .curves = {exact, ours}};
}

real discharge_error(const RunRecord& run, const Reference& ref) {
    const auto &h = needed_field(run.fields, "", "depth").data[0], &u = needed_field(run.fields, "", "velocity").data[0];
    const real q = ref.number("discharge");
    real worst = 0;
    for (std::size_t c = 0; c < h.size(); ++c) worst = std::max(worst, std::abs(h[c] * u[c] - q) / q);
    return worst;
}

/// Where the last shooting column meets tranquil water.
real jump_error(const RunRecord& run, const Reference& ref) {
    const auto &h = needed_field(run.fields, "", "depth").data[0], &u = needed_field(run.fields, "", "velocity").data[0];
    const real g = -needed_effect(*run.scene, "gravity").numbers("g").at(1);
    const GridView& grid = run.fields.grid;
    real at = std::nan("");
    for (std::size_t c = 0; c + 1 < h.size(); ++c)
        if (u[c] * u[c] > g * h[c] && u[c + 1] * u[c + 1] <= g * h[c + 1])
            at = grid.origin[0] + grid.spacing[0] * (static_cast<real>(c) + 1);
    return std::abs(at - ref.number("jump"));
}

const scene::Table& first_float(const RunRecord& run) { return run.scene->root().tables("floats").at(0); }

/// Displaced volume over the area of the box, against what its weight asks for.
real draft_error(const RunRecord& run, const Reference& ref) {
    const auto& size = first_float(run).numbers("size");
    const real area = size.size() == 3 ? size[0] * size[2] : size[0];
    return std::abs(run.series("float0_displaced").y.back() / area / ref.number("draft") - 1);
}

/// Height above where it comes to rest.
Curve heave(const RunRecord& run, const Reference& ref) {
    Curve c = run.series("float0_height");
    for (real& y : c.y) y += ref.number("draft");
    c.label = "weir";
    return c;
}
Curve heave_of(const Reference& ref, const std::vector<real>& times) {
    Curve c{.label = ref.source, .x = {}, .y = {}};
    for (const real t : times) c.x.push_back(t), c.y.push_back(cubic(ref.curve("height"), t) + ref.number("draft"));
    return c;
}
Panel heave_panel(const RunRecord& run, const Reference& ref) {
    const Curve ours = heave(run, ref);
    Curve exact = heave_of(ref, ours.x);
    exact.dashed = true;
    return {.title = "Height above rest", .x = {"t [s]"}, .y = {"[m]"}, .curves = {exact, ours}};
}
real heave_frequency_error(const RunRecord& run, const Reference& ref) {
    const Curve ours = heave(run, ref);
    return std::abs(frequency(ours) / frequency(heave_of(ref, ours.x)) - 1);
}
real heave_history_error(const RunRecord& run, const Reference& ref) {
    const Curve ours = heave(run, ref), exact = heave_of(ref, ours.x);
    real sum = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) sum += (ours.y[i] - exact.y[i]) * (ours.y[i] - exact.y[i]);
    return std::sqrt(sum / static_cast<real>(ours.size())) / std::abs(ref.number("start"));
}

/// Angle between the way of a dragged object and the crest of its wake: a straight line through the highest surface of each row of columns
/// that lies between two and six widths beside the way.
real wake_angle_error(const RunRecord& run, const Reference& ref) {
    const auto& s = needed_field(run.fields, "", "surface").data[0];
    const GridView& g = run.fields.grid;
    const real way = first_float(run).numbers("at").at(2), width = first_float(run).numbers("size").at(2);
    real n = 0, sz = 0, sx = 0, szz = 0, szx = 0;
    for (int k = 0; k < g.cells[2]; ++k) {
        const real z = std::abs(g.origin[2] + g.spacing[2] * (k + 0.5) - way);
        if (z < 2 * width || z > 6 * width) continue;
        const auto row = s.begin() + static_cast<std::ptrdiff_t>(k) * g.cells[0];
        const auto top = std::max_element(row + 1, row + g.cells[0] - 1);
        const real curve = 2 * top[0] - top[-1] - top[1], shift = curve > 0 ? 0.5 * (top[1] - top[-1]) / curve : 0;
        const real x = g.origin[0] + g.spacing[0] * (static_cast<real>(top - row) + 0.5 + shift);
        n += 1, sz += z, sx += x, szz += z * z, szx += z * x;
    }
    const real slope = (n * szx - sz * sx) / (n * szz - sz * sz);  // dx/dz: the wake lags behind
    return std::abs(std::atan(-1 / slope) / ref.number("angle") - 1);
}

}  // namespace

std::vector<Metric> height_field_metrics() {
    return {
        {.name = "float.draft_error",
         .unit = "",
         .doc =
             "Relative difference of the volume that the first float displaces at the end, over its area, to the draft that it floats at.",
         .measure = draft_error},
        {.name = "heave.frequency_error",
         .unit = "",
         .doc = "Relative error of the frequency of the first float, from zero crossings; the reference is measured the same way.",
         .measure = heave_frequency_error,
         .figure = heave_panel},
        {.name = "heave.history_error",
         .unit = "",
         .doc = "Root mean square difference of the first float's height to the reference, over how high it was released.",
         .measure = heave_history_error},
        {.name = "wake.angle_error",
         .unit = "",
         .doc = "Relative error of the angle of the wake's crest, by a line through the highest surface of each row beside the way.",
         .measure = wake_angle_error},
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
