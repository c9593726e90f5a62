// Flow past no-slip solids: drag, shedding and recirculation behind a cylinder, where flow behind a step reattaches.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

namespace weir::validation {
namespace {

/// What a run shows after its first three fifths, when a wake has forgotten how it began.
Curve settled(const Curve& c) {
    Curve late{.label = c.label};
    for (std::size_t i = 0; i < c.size(); ++i)
        if (c.x[i] >= 0.6 * c.x.back()) late.x.push_back(c.x[i]), late.y.push_back(c.y[i]);
    return late;
}

struct Cylinder {
    Vec<2> centre;
    real diameter, speed, density;
    explicit Cylinder(const scene::Scene& scene) {
        const scene::Table& solid = scene.root().tables("solids").at(0);
        centre = solid.vec<2>("centre"), diameter = 2 * solid.number("radius");
        speed = scene.root().numbers("sides.x_min.velocity").at(0), density = scene.number("fluid.density");
    }
    real coefficient(real force) const { return 2 * force / (density * speed * speed * diameter); }
};

/// Mean in time by trapezia.
real mean_of(const Curve& c) {
    real area = 0;
    for (std::size_t i = 1; i < c.size(); ++i) area += 0.5 * (c.y[i] + c.y[i - 1]) * (c.x[i] - c.x[i - 1]);
    return area / (c.x.back() - c.x.front());
}

/// Where a curve turns from negative to positive last; NaN if nowhere.
real last_rise(const Curve& c) {
    real at = not_applicable;
    for (std::size_t i = 1; i < c.size(); ++i)
        if (c.y[i - 1] < 0 && c.y[i] >= 0) at = c.x[i - 1] + (c.x[i] - c.x[i - 1]) * c.y[i - 1] / (c.y[i - 1] - c.y[i]);
    return at;
}

Curve velocity_along(const RunRecord& run, real height) {
    return along_line(needed_field(run.fields, "", "velocity"), run.fields.grid, 0, Vec<3>{0, height, 0}, 0);
}

real wake_length(const RunRecord& run, const Reference&) {
    const Cylinder cylinder(*run.scene);
    return (last_rise(velocity_along(run, cylinder.centre[1])) - cylinder.centre[0]) / cylinder.diameter - 0.5;
}

real reattachment(const RunRecord& run, const Reference&) {
    const scene::Table& step = run.scene->root().tables("solids").at(0);
    const Vec<2> corner = step.vec<2>("max");
    const GridView& g = run.fields.grid;
    return (last_rise(velocity_along(run, g.origin[1] + 0.5 * g.spacing[1])) - corner[0]) / (corner[1] - g.origin[1]);
}

}  // namespace

std::vector<Metric> flow_past_metrics() {
    return {
        {.name = "cylinder.drag",
         .unit = "",
         .doc = "Drag of the first solid, a disc, over half of the fluid's density, its diameter and the square of the inflow's speed: the "
                "mean "
                "of the last two fifths of the run.",
         .quantity = Quantity::value,
         .measure = [](const RunRecord& run,
                       const Reference&) { return Cylinder(*run.scene).coefficient(mean_of(settled(run.series("solid_force_x")))); }},
        {.name = "cylinder.strouhal",
         .unit = "",
         .doc = "Frequency of its lift in the last two fifths of the run, by its diameter over the inflow's speed.",
         .quantity = Quantity::value,
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const Cylinder cylinder(*run.scene);
                 return frequency(settled(run.series("solid_force_y"))) / (2 * pi) * cylinder.diameter / cylinder.speed;
             }},
        {.name = "cylinder.wake_length",
         .unit = "",
         .doc = "Length of the eddies behind it at the end, from its rear to where the velocity on the axis turns, in diameters.",
         .quantity = Quantity::value,
         .measure = wake_length},
        {.name = "step.reattachment",
         .unit = "",
         .doc = "Distance from the first solid, a step on the floor, to where the flow along the floor turns, in heights of the step.",
         .quantity = Quantity::value,
         .measure = reattachment},
    };
}

}  // namespace weir::validation
