// Enclosed air against references/air.cpp.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Length of the gas in a shaft: its volume over that of a metre.
Curve gas_length(const RunRecord& run, const Reference& ref) {
    Curve c = run.series("largest_pocket_volume");
    const real scale = ref.number("length") / c.y.front();
    for (real& y : c.y) y *= scale;
    c.label = "weir";
    return c;
}

std::size_t turn(const Curve& length) {
    return static_cast<std::size_t>(std::min_element(length.y.begin(), length.y.end()) - length.y.begin());
}

real turn_error(const RunRecord& run, const Reference& ref) {
    const Curve length = gas_length(run, ref);
    return std::abs(length.y[turn(length)] / ref.number("least") - 1);
}

real time_error(const RunRecord& run, const Reference& ref) {
    const Curve length = gas_length(run, ref);
    return std::abs(length.x[turn(length)] / ref.number("time") - 1);
}

real pressure_error(const RunRecord& run, const Reference& ref) {
    const Curve p = run.series("largest_pocket_pressure");
    return std::abs(*std::max_element(p.y.begin(), p.y.end()) / ref.number("pressure") - 1);
}

/// Mean over the second half of the run, in which the water swings about its rest.
real glass_error(const RunRecord& run, const Reference& ref) {
    const Curve volume = run.series("largest_pocket_volume");
    real sum = 0, count = 0;
    for (std::size_t i = volume.size() / 2; i < volume.size(); ++i) sum += volume.y[i], count += 1;
    return std::abs(sum / count / ref.number("volume") - 1);
}

/// From the time at which the rim closes the air to the end of the run.
real volume_lost(const RunRecord& run, const Reference&) {
    const Curve volume = run.series("largest_pocket_volume");
    const auto first = std::find_if(volume.y.begin(), volume.y.end(), [](real y) { return y > 0; });
    return first == volume.y.end() ? 1 : std::abs(volume.y.back() / *first - 1);
}

/// The hollow above the lip of a block or a bell: the first solid, a box less boxes, the last of which is the hollow.
struct Hollow {
    Vec<2> low, high;
    explicit Hollow(const scene::Scene& scene) {
        const scene::Table& block = scene.root().tables("solids").at(0);
        const auto& boxes = block.tables("minus");
        const scene::Table& inside = boxes.at(boxes.size() - 1);  // throws where there is none
        for (std::size_t a = 0; a < 2; ++a) low[a] = inside.numbers("min").at(a), high[a] = inside.numbers("max").at(a);
        low[1] = block.table("from").numbers("min").at(1);
    }
    bool contains(const Vec<3>& x) const { return x[0] > low[0] && x[0] < high[0] && x[1] > low[1] && x[1] < high[1]; }
};

/// The part of the hollow that is not liquid. A cell's part is that of a plane at the distance of the level set.
real air_in_hollow(const FieldSet& fields, const scene::Scene& scene, real) {
    const FieldView& phi = needed_field(fields, "", level_set_name);
    const Hollow hollow(scene);
    const real h = fields.grid.spacing[1];
    real air = 0, cells = 0;
    for_each_sample(fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) {
        if (hollow.contains(x)) air += std::clamp(0.5 + phi.data[0][i] / h, 0.0, 1.0), cells += 1;
    });
    return air / cells;
}

/// Pressure under the roof of the hollow, by the probe of that name.
Curve roof_pressure(const RunRecord& run) {
    Curve p = run.series("probe.roof");
    p.label = "weir";
    return p;
}

/// Mean over the last third of the run: the bore has been reflected.
real hollow_pressure_error(const RunRecord& run, const Reference& ref) {
    const Curve p = roof_pressure(run);
    real sum = 0, time = 0;
    for (std::size_t i = 1; i < p.size(); ++i)
        if (p.x[i] > 2 * run.time / 3) sum += (p.x[i] - p.x[i - 1]) * p.y[i], time += p.x[i] - p.x[i - 1];
    return std::abs(sum / time / ref.number("head") - 1);
}

real closing_error(const RunRecord& run, const Reference& ref) {
    const Curve p = roof_pressure(run);
    const auto first = std::find_if(p.y.begin(), p.y.end(), [&](real y) { return y > 0.5 * ref.number("head"); });
    return first == p.y.end() ? 1 : std::abs(p.x[static_cast<std::size_t>(first - p.y.begin())] / ref.number("arrival") - 1);
}

/// Discharge coefficient of the hole of a bell, the first of the boxes that its solid lacks: gas that leaves the bell over w ∫ sqrt(2 Δp/ρ)
/// dt, in the middle half of the run. Pressures are those of the probes `roof` and `outside`, in gas at one height.
real discharge(const RunRecord& run, const Reference&) {
    const scene::Table& hole = run.scene->root().tables("solids").at(0).tables("minus").at(0);
    const Hollow bell(*run.scene);
    const real width = hole.numbers("max").at(0) - hole.numbers("min").at(0), rho = run.scene->number("gas.density");
    const Curve air = run.series("bell.discharge"), inside = run.series("probe.roof"), outside = run.series("probe.outside");
    const real from = run.time / 4, to = 3 * run.time / 4;
    real torricelli = 0;
    for (std::size_t i = 1; i < inside.size(); ++i)
        if (inside.x[i] > from && inside.x[i] <= to)
            torricelli += (inside.x[i] - inside.x[i - 1]) * std::sqrt(2 * std::max(0.0, inside.y[i] - outside.y[i]) / rho);
    const real left = (interpolate(air, from) - interpolate(air, to)) * (bell.high[0] - bell.low[0]) * (bell.high[1] - bell.low[1]);
    return left / (width * torricelli);
}

/// The figure of air_in_hollow over time.
auto air_panel(const char* metric, const char* title) {
    return [=](const RunRecord& run, const Reference&) {
        Curve air = run.series(metric);
        air.label = "weir";
        return Panel{.title = title, .x = {"t [s]"}, .y = {"part of the hollow"}, .curves = {air}};
    };
}

}  // namespace

std::vector<Metric> air_metrics() {
    return {
        {.name = "piston.turn_error",
         .unit = "",
         .doc = "Relative error of the least length of a gas cushion under a column of water.",
         .measure = turn_error,
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Gas cushion", .x = {"t [s]"}, .y = {"x [m]"}, .curves = {ref.curve("gas"), gas_length(run, ref)}};
             }},
        {.name = "piston.time_error",
         .unit = "",
         .doc = "Relative error of the time at which a gas cushion is shortest.",
         .measure = time_error},
        {.name = "piston.pressure_error",
         .unit = "",
         .doc = "Relative error of the largest absolute pressure of a gas cushion.",
         .measure = pressure_error},
        {.name = "glass.volume_error",
         .unit = "",
         .doc = "Relative error of the mean volume of the largest pocket of air over the last half of the run, to that at rest.",
         .measure = glass_error},
        {.name = "glass.volume_lost",
         .unit = "",
         .doc = "Relative change of the volume of the largest pocket of air from the time at which it was enclosed to the end.",
         .measure = volume_lost},
        {.name = "hollow.pressure_error",
         .unit = "",
         .doc =
             "Relative error of the mean pressure under the roof of a hollow over the last third of the run, to the head of the reflected "
             "bore that closed it.",
         .measure = hollow_pressure_error,
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Pressure of the trapped air",
                              .x = {"t [s]"},
                              .y = {"p [Pa]"},
                              .curves = {ref.curve("head"), roof_pressure(run)}};
             }},
        {.name = "hollow.closing_error",
         .unit = "",
         .doc =
             "Relative error of the time at which the pressure under the roof exceeds half of the head of the reflected bore, to that at "
             "which the bore arrives.",
         .measure = closing_error},
        {.name = "hollow.least_air",
         .unit = "",
         .doc = "Over the run, the least part of the hollow above the lip that is not liquid.",
         .quantity = Quantity::value,
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const std::vector<real> all = run.series("hollow.least_air").y;
                 return *std::min_element(all.begin(), all.end());
             },
         .figure = air_panel("hollow.least_air", "Air in the hollow"),
         .observe = air_in_hollow},
        {.name = "bell.discharge",
         .unit = "",
         .doc = "Discharge coefficient of the hole of a bell: gas that leaves over w sqrt(2 dp/rho), in the middle half of the run.",
         .quantity = Quantity::value,
         .measure = discharge,
         .figure = air_panel("bell.discharge", "Gas in the bell"),
         .observe = air_in_hollow},
    };
}

}  // namespace weir::validation
