// Cavities: velocity on the centrelines against tables, heat through the walls against single numbers.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"

#include <algorithm>

namespace weir::validation {
namespace {

/// Component c of the velocity along the centreline across it (u along y, v along x), closed by what the walls say.
Curve centreline(const RunRecord& run, int c) {
    const GridView& g = run.fields.grid;
    const int axis = 1 - c;
    const auto A = static_cast<std::size_t>(axis);
    const Curve inner = along_line(needed_field(run.fields, "", "velocity"), g, c, middle(g), axis);
    const real lid = c == 0 ? run.scene->root().numbers("sides.y_max.velocity").at(0) : 0;
    Curve line{.label = "weir", .x = {g.origin[A]}, .y = {0}};
    line.x.insert(line.x.end(), inner.x.begin(), inner.x.end());
    line.y.insert(line.y.end(), inner.y.begin(), inner.y.end());
    line.x.push_back(g.origin[A] + g.spacing[A] * g.cells[A]);
    line.y.push_back(lid);
    return line;
}

/// Root mean square over the table's points inside the walls (on the walls any code is right), between our samples by cubics.
real centreline_rms(const RunRecord& run, const Reference& ref, int c) {
    const Curve ours = centreline(run, c);
    const Curve& table = ref.curve(c == 0 ? "centreline.u" : "centreline.v");
    real sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (table.x[i] <= ours.x.front() || table.x[i] >= ours.x.back()) continue;
        const real error = cubic(ours, table.x[i]) - table.y[i];
        sum += error * error, ++count;
    }
    return std::sqrt(sum / count);
}

Panel centreline_panel(const RunRecord& run, const Reference& ref, int c) {
    const std::string name = c == 0 ? "centreline.u" : "centreline.v";
    Panel panel{.title = c == 0 ? "u on the vertical centreline" : "v on the horizontal centreline",
                .x = {c == 0 ? "y [m]" : "x [m]"},
                .y = {c == 0 ? "u [m/s]" : "v [m/s]"},
                .curves = {ref.curve(name)}};
    if (ref.curves.count(name + ".ghia")) panel.curves.push_back(ref.curve(name + ".ghia"));
    panel.curves.push_back(centreline(run, c));
    return panel;
}

// --- Heat ---------------------------------------------------------------------------------------------------------------------------

struct Heat {
    real hot, cold, alpha, L, height;
};
/// Of the effect, of the liquid of two phases, or of the liquid where the scene names a substance [m^2/s].
real diffusivity_of(const scene::Scene& scene) {
    if (scene.effect("heat"))
        return scene.number("fluid.conductivity") / (scene.number("fluid.density") * scene.number("fluid.heat_capacity"));
    if (const auto* diffusion = scene.effect("diffusion")) return diffusion->number("temperature");
    return scene.number("substance.liquid.conductivity") / (scene.number("fluid.density") * scene.number("substance.liquid.heat_capacity"));
}

Heat heat_of(const RunRecord& run) {
    const auto& size = run.scene->root().numbers("grid.size");
    return {run.scene->number("sides.x_min.temperature"), run.scene->number("sides.x_max.temperature"), diffusivity_of(*run.scene),
            size.at(0), size.at(1)};
}

/// Mean over y of the heat flux u T - alpha dT/dx through plane i of x faces, over alpha dT / L: the Nusselt number of that plane.
real nusselt_of_plane(const RunRecord& run, int i) {
    const GridView& g = run.fields.grid;
    const Heat heat = heat_of(run);
    const FieldView &u = needed_field(run.fields, "", "velocity"), &T = needed_field(run.fields, "", "temperature");
    const int n = g.cells[0];
    const real h = g.spacing[0];
    real sum = 0;
    for (int j = 0; j < g.cells[1]; ++j) {
        const auto t = [&](int at) { return value_at(T, g, 0, {at, j, 0}); };
        real slope, value;
        if (i == 0) {  // at walls: the parabola through the wall's value and two cells
            slope = (-8 * heat.hot + 9 * t(0) - t(1)) / (3 * h), value = heat.hot;
        } else if (i == n) {
            slope = (8 * heat.cold - 9 * t(n - 1) + t(n - 2)) / (3 * h), value = heat.cold;
        } else {
            slope = (t(i) - t(i - 1)) / h, value = (t(i) + t(i - 1)) / 2;
        }
        sum += value_at(u, g, 0, {i, j, 0}) * value - heat.alpha * slope;
    }
    return sum / g.cells[1] / (heat.alpha * (heat.hot - heat.cold) / heat.L);
}

real nusselt_mean(const RunRecord& run) {
    const int n = run.fields.grid.cells[0];
    real sum = 0;
    for (int i = 0; i <= n; ++i) sum += (i == 0 || i == n ? 0.5 : 1.0) * nusselt_of_plane(run, i);
    return sum / n;
}

/// Largest velocity on a centreline (u along y for c = 0), in units of alpha / L, at the top of the cubic's neighbourhood.
real largest_on_centreline(const RunRecord& run, const Reference& ref, int c) {
    const GridView& g = run.fields.grid;
    const Curve line = along_line(needed_field(run.fields, "", "velocity"), g, c, middle(g), 1 - c);
    real largest = 0;
    const int fine = 20 * static_cast<int>(line.size());
    for (int i = 0; i <= fine; ++i)
        largest = std::max(largest, cubic(line, line.x.front() + (line.x.back() - line.x.front()) * std::min(1.0, real(i) / fine)));
    return largest / ref.number("speed_unit");
}

real relative_error(real measured, real reference) { return std::abs(measured / reference - 1); }

}  // namespace

std::vector<Metric> cavity_metrics() {
    return {
        {.name = "centreline.u_rms",
         .unit = "m/s",
         .doc = "Root mean square difference to the table of u on the vertical centreline, walls left out.",
         .measure = [](const RunRecord& run, const Reference& ref) { return centreline_rms(run, ref, 0); },
         .figure = [](const RunRecord& run, const Reference& ref) { return centreline_panel(run, ref, 0); }},
        {.name = "centreline.v_rms",
         .unit = "m/s",
         .doc = "Root mean square difference to the table of v on the horizontal centreline, walls left out.",
         .measure = [](const RunRecord& run, const Reference& ref) { return centreline_rms(run, ref, 1); },
         .figure = [](const RunRecord& run, const Reference& ref) { return centreline_panel(run, ref, 1); }},
        {.name = "nusselt.mean_error",
         .unit = "",
         .doc = "Relative error of the Nusselt number averaged over the cavity.",
         .measure = [](const RunRecord& run, const Reference& ref) { return relative_error(nusselt_mean(run), ref.number("Nu_mean")); }},
        {.name = "nusselt.wall_error",
         .unit = "",
         .doc = "Relative error of the Nusselt number at the hot wall.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return relative_error(nusselt_of_plane(run, 0), ref.number("Nu_0")); }},
        {.name = "convection.u_max_error",
         .unit = "",
         .doc = "Relative error of the largest u on the vertical centreline.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return relative_error(largest_on_centreline(run, ref, 0), ref.number("u_max")); }},
        {.name = "convection.v_max_error",
         .unit = "",
         .doc = "Relative error of the largest v on the horizontal centreline.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return relative_error(largest_on_centreline(run, ref, 1), ref.number("v_max")); }},
        {.name = "steady.change",
         .unit = "m/s",
         .doc = "Change of the mean speed over the last tenth of the run: how steady the end state is.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const Curve s = run.series("steady.change");
                 const real from = interpolate(s, s.x.back() - 0.1 * (s.x.back() - s.x.front()));
                 return std::abs(s.y.back() - from);
             },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return std::sqrt(2 * mean_kinetic_energy(fields)); }},
    };
}

}  // namespace weir::validation
