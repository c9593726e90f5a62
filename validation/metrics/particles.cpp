// What particles did: columns at rest, drops and patches by their moments, Laplace's pressure, momentum that nothing put in.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace weir::validation {
namespace {

const FieldView& particles(const FieldSet& fields, const char* name) {
    const FieldView* f = fields.find("particles", name);
    if (!f) throw BadInput(std::string("the solver shows no particles with \"") + name + "\"");
    return *f;
}

/// Mean over the columns of the grid's cells of the highest particle in each, and half a spacing.
real surface_height(const FieldSet& fields) {
    const auto& x = particles(fields, "position").data;
    const GridView& g = fields.grid;
    std::map<std::pair<int, int>, real> highest;
    for (std::size_t i = 0; i < x[0].size(); ++i) {
        const auto cell = [&](std::size_t a) { return a < x.size() ? static_cast<int>((x[a][i] - g.origin[a]) / g.spacing[a]) : 0; };
        auto [at, first] = highest.try_emplace({cell(0), cell(2)}, x[1][i]);
        at->second = std::max(at->second, x[1][i]);
    }
    real sum = 0;
    for (const auto& [cell, y] : highest) sum += y;
    return sum / static_cast<real>(highest.size()) + 0.5 * g.spacing[1] - g.origin[1];
}

/// Volume over area of the tank's floor: where the surface of a liquid that is not compressed stands.
real full_height(const RunRecord& run) {
    const GridView& g = run.fields.grid;
    real floor = g.cells[0] * g.spacing[0];
    if (g.dim == 3) floor *= g.cells[2] * g.spacing[2];
    return run.series("volume").y.front() / floor;
}

/// The largest value of an integral in the last tenth of the run.
real largest_late(const RunRecord& run, const char* integral) {
    Curve late, all = run.series(integral);
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all.x[i] >= 0.9 * run.time) late.y.push_back(all.y[i]);
    return largest(late);
}

/// Semi-axes of the ellipse of uniform density that has the particles' second moments: <x^2> = a^2 / 4, and each particle's own square of
/// side d adds d^2 / 12 to the mean.
real semi_axis(const FieldSet& fields, std::size_t axis) {
    const auto& x = particles(fields, "position").data[axis];
    const auto n = static_cast<real>(x.size());
    real mean = 0, square = 0;
    for (const real v : x) mean += v / n;
    for (const real v : x) square += (v - mean) * (v - mean) / n;
    const real d = fields.grid.spacing[axis];
    return 2 * std::sqrt(square + d * d / 12);
}

real axis_error(const RunRecord& run, const Reference& ref, const char* name, std::size_t axis) {
    const Curve& exact = ref.curve(name);
    return std::abs(semi_axis(run.fields, axis) / interpolate(exact, std::min(run.time, exact.x.back())) - 1);
}

/// Mean over the particles closer than `radius` to x.
real mean_near(const FieldSet& fields, const char* name, const std::vector<real>& at, real radius) {
    const auto &x = particles(fields, "position").data, &value = particles(fields, name).data;
    real sum = 0, seen = 0;
    for (std::size_t i = 0; i < x[0].size(); ++i) {
        real square = 0;
        for (std::size_t a = 0; a < x.size(); ++a) square += (x[a][i] - at[a]) * (x[a][i] - at[a]);
        if (square <= radius * radius) sum += value[0][i], seen += 1;
    }
    return sum / seen;
}

/// Pressure of the patch at `place` (over its side, from the centre, turning with it).
real patch_pressure(const FieldSet& fields, const scene::Scene& scene, real t, const Vec<2>& place) {
    const scene::Table& box = scene.root().tables("liquid").at(0);
    const Vec<2> lo = box.vec<2>("min"), hi = box.vec<2>("max");
    const real L = hi[0] - lo[0], angle = scene.number("initial.velocity.omega") * t;
    const Vec<2> at = 0.5 * (lo + hi) + L * Vec<2>{std::cos(angle) * place[0] - std::sin(angle) * place[1],
                                                   std::sin(angle) * place[0] + std::cos(angle) * place[1]};
    return mean_near(fields, "pressure", {at[0], at[1]}, 0.05 * L);
}

/// Mean with the window 1 - cos: sound that rings around the value it starts from drops out with the cube of its number of periods.
real without_ringing(const Curve& c) {
    real sum = 0, weight = 0;
    for (std::size_t i = 1; i < c.size(); ++i) {
        const real w = (1 - std::cos(2 * pi * c.x[i] / c.x.back())) * (c.x[i] - c.x[i - 1]);
        sum += w * c.y[i], weight += w;
    }
    return sum / weight;
}

Metric patch_metric(const std::string& name, const char* number, Vec<2> place) {
    return {.name = name,
            .unit = "",
            .doc = "Relative error of the pressure in a patch that starts to rotate, its mean over the run with the window 1 - cos.",
            .measure = [=](const RunRecord& run,
                           const Reference& ref) { return std::abs(without_ringing(run.series(name)) / ref.number(number) - 1); },
            .observe = [=](const FieldSet& fields, const scene::Scene& scene, real t) { return patch_pressure(fields, scene, t, place); }};
}

/// Largest length of the momentum's change over mass times the largest speed of the run.
real momentum_drift(const RunRecord& run, const Reference&) {
    real worst = 0;
    for (const char* axis : {"momentum_x", "momentum_y"}) {
        const Curve p = run.series(axis);
        for (const real y : p.y) worst = std::max(worst, std::abs(y - p.y.front()));
    }
    return worst / (run.series("mass").y.front() * largest(run.series("max_speed")));
}

std::vector<Metric> of_columns() {
    return {
        {.name = "column.speed",
         .unit = "",
         .doc = "Largest speed of any particle in the last tenth of the run, over sqrt(g H).",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return largest_late(run, "max_speed") / std::sqrt(ref.number("gravity") * ref.number("depth"));
             }},
        {.name = "column.height_error",
         .unit = "",
         .doc = "|height of the surface - volume / area of the floor| at the end, in spacings; the surface: mean of the highest particles.",
         .measure = [](const RunRecord& run,
                       const Reference&) { return std::abs(surface_height(run.fields) - full_height(run)) / run.fields.grid.spacing[1]; }},
        {.name = "column.height_drift",
         .unit = "",
         .doc = "Largest departure of the surface's height from what it was first, in spacings.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const Curve h = run.series("column.height_drift");
                 real worst = 0;
                 for (const real y : h.y) worst = std::max(worst, std::abs(y - h.y.front()));
                 return worst / run.fields.grid.spacing[1];
             },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return surface_height(fields); }},
    };
}

std::vector<Metric> of_drops() {
    return {
        {.name = "drop.a_error",
         .unit = "",
         .doc = "Relative error of the semi-axis along x at the end, by the particles' second moments.",
         .measure = [](const RunRecord& run, const Reference& ref) { return axis_error(run, ref, "a", 0); },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Semi-axes",
                              .x = {"t [s]"},
                              .y = {"a, b [m]"},
                              .curves = {ref.curve("a"), ref.curve("b"), run.series("drop.a_error"), run.series("drop.b_error")}};
             },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return semi_axis(fields, 0); }},
        {.name = "drop.b_error",
         .unit = "",
         .doc = "Relative error of the semi-axis along y at the end, by the particles' second moments.",
         .measure = [](const RunRecord& run, const Reference& ref) { return axis_error(run, ref, "b", 1); },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return semi_axis(fields, 1); }},
        {.name = "drop.laplace_error",
         .unit = "",
         .doc = "Relative error of the mean pressure in the inner half of a drop, over the last half of the run.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve p = run.series("drop.laplace_error");
                 real sum = 0, seen = 0;
                 for (std::size_t i = p.size() / 2; i < p.size(); ++i) sum += p.y[i], seen += 1;
                 return std::abs(sum / seen / ref.number("pressure") - 1);
             },
         .observe =
             [](const FieldSet& fields, const scene::Scene& scene, real) {
                 const scene::Table& drop = scene.root().tables("liquid").at(0);
                 return mean_near(fields, "pressure", drop.numbers("centre"), 0.5 * drop.number("radius"));
             }},
    };
}

}  // namespace

std::vector<Metric> particle_metrics() {
    std::vector<Metric> list = of_columns();
    for (auto& m : of_drops()) list.push_back(std::move(m));
    list.push_back(patch_metric("patch.centre_error", "centre", {0, 0}));
    list.push_back(patch_metric("patch.quarter_error", "quarter", {0.25, 0.25}));
    list.push_back({.name = "particles.momentum_drift",
                    .unit = "",
                    .doc = "Largest change of momentum along x or y over mass times the largest speed of the run.",
                    .measure = momentum_drift});
    return list;
}

}  // namespace weir::validation
