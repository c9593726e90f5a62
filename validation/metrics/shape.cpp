// What advection did to a shape: area and symmetric difference of a level set by 8 x 8 points a cell, and the peak of a hill; each can be
// compared with the error that an independent implementation of the same scheme makes on the same grid.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

constexpr int points_per_cell = 8;  // along each axis, as the baselines were measured

/// Bilinear between cell centres; beyond the outermost the nearest value.
real bilinear(const FieldView& f, const GridView& g, real i, real j) {
    const auto at = [](real s, int n) { return std::clamp(static_cast<int>(std::floor(s)), 0, n - 2); };
    const int i0 = at(i, g.cells[0]), j0 = at(j, g.cells[1]);
    const real s = std::clamp(i - i0, 0.0, 1.0), t = std::clamp(j - j0, 0.0, 1.0);
    const auto v = [&](int di, int dj) { return value_at(f, g, 0, {i0 + di, j0 + dj, 0}); };
    return (1 - t) * ((1 - s) * v(0, 0) + s * v(1, 0)) + t * ((1 - s) * v(0, 1) + s * v(1, 1));
}

struct Areas {
    real ours = 0, difference = 0;  // [m^2]
};

Areas areas(const RunRecord& run, const Reference& ref) {
    const FieldView& phi = needed_field(run.fields, "", "level_set");
    const GridView& g = run.fields.grid;
    const ScalarField& exact = ref.scalar("level_set");
    long inside = 0, different = 0;
    for (int q = 0; q < points_per_cell * g.cells[1]; ++q)
        for (int p = 0; p < points_per_cell * g.cells[0]; ++p) {
            const real i = (p + 0.5) / points_per_cell, j = (q + 0.5) / points_per_cell;  // in cells from the lower corner
            const Vec<3> x{g.origin[0] + g.spacing[0] * i, g.origin[1] + g.spacing[1] * j, 0};
            const bool ours = bilinear(phi, g, i - 0.5, j - 0.5) < 0, theirs = exact(x, run.time) < 0;
            inside += ours, different += ours != theirs;
        }
    const real unit = cell_volume(g) / (points_per_cell * points_per_cell);
    return {static_cast<real>(inside) * unit, static_cast<real>(different) * unit};
}

/// The baselines' name of the scene's scheme.
std::string baseline_scheme(const scene::Scene& scene) {
    const std::string &advection = scene.text("scheme.advection"), interpolation = scene.root().text_or("scheme.interpolation", "linear");
    if (advection == "maccormack") return scene.root().text_or("scheme.limiter", "clamp") == "none" ? "MacCormack" : "MacCormack-clamped";
    if (advection == "semi_lagrangian") return interpolation == "linear" ? "SL-linear" : "SL-cubic";
    throw BadInput("no baseline for advection \"" + advection + "\"");
}

/// Our number over the baseline's on the same grid.
real over_baseline(const RunRecord& run, const Reference& ref, real ours, const std::string& which) {
    return ours / ref.number(baseline_scheme(*run.scene) + "." + std::to_string(run.fields.grid.cells[0]) + which);
}

real rms_error(const RunRecord& run, const Reference& ref) {
    const auto& data = needed_field(run.fields, "", "tracer").data[0];
    const ScalarField& exact = ref.scalar("tracer");
    real sum = 0;
    for_each_sample(run.fields.grid, -1,
                    [&](const Vec<3>& x, real, std::size_t i) { sum += (data[i] - exact(x, run.time)) * (data[i] - exact(x, run.time)); });
    return std::sqrt(sum / static_cast<real>(data.size()));
}

}  // namespace

std::vector<Metric> shape_metrics() {
    return {
        {.name = "shape.area_change",
         .unit = "",
         .doc = "|area - exact area| / exact area inside the zero of the level set.",
         .measure = [](const RunRecord& run, const Reference& ref) { return std::abs(areas(run, ref).ours / ref.number("area") - 1); }},
        {.name = "shape.symmetric_difference",
         .unit = "m^2",
         .doc = "Area that is inside one of computed and exact shape, but not the other.",
         .measure = [](const RunRecord& run, const Reference& ref) { return areas(run, ref).difference; }},
        {.name = "shape.over_baseline",
         .unit = "",
         .doc = "Symmetric difference over that of an independent implementation of the same scheme on the same grid.",
         .quantity = Quantity::value,
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return over_baseline(run, ref, areas(run, ref).difference, ".second"); }},
        {.name = "tracer.over_baseline",
         .unit = "",
         .doc = "RMS error over that of an independent implementation of the same scheme on the same grid.",
         .quantity = Quantity::value,
         .measure = [](const RunRecord& run, const Reference& ref) { return over_baseline(run, ref, rms_error(run, ref), ".second"); }},
    };
}

}  // namespace weir::validation
