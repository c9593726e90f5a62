// Melting and freezing: fronts, what ice and water come to, and the balance of heat.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// How far the front has come: the liquid's volume over the box's height, which does not jump from cell to cell.
Curve front(const RunRecord& run) {
    Curve curve = run.series("liquid_volume");
    const auto& size = run.scene->root().numbers("grid.size");
    for (real& y : curve.y)
        for (std::size_t d = 1; d < size.size(); ++d) y /= size[d];
    return curve;
}

real exact_front(const Reference& ref, real t) { return ref.number("speed") * std::sqrt(t); }

/// Of all moments of the second half of the run: the front of particles goes on by steps, of which the last moment catches one.
real mean_front_error(const RunRecord& run, const Reference& ref) {
    const Curve x = front(run);
    real ours = 0, exact = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x.x[i] > run.time / 2) ours += x.y[i], exact += exact_front(ref, x.x[i]);
    return std::abs(ours / exact - 1);
}

Panel front_panel(const RunRecord& run, const Reference& ref) {
    Curve ours = front(run), exact{.points = true};
    ours.label = "weir";
    exact.label = fmt::format("2 lambda sqrt(alpha t), lambda = {:.4f}", ref.number("lambda"));
    for (int i = 1; i <= 20; ++i) exact.x.push_back(run.time * i / 20), exact.y.push_back(exact_front(ref, exact.x.back()));
    return {.title = "The front of melting", .x = {"t [s]"}, .y = {"x [m]"}, .curves = {exact, ours}};
}

/// Of all that is there, as liquid: of particles theirs, else the box is full.
real volume_of(const RunRecord& run) {
    if (run.fields.find("particles", "position")) return run.series("volume").y.front();
    real volume = 1;
    for (const real s : run.scene->root().numbers("grid.size")) volume *= s;
    return volume;
}

/// What a box of ice and water at two temperatures comes to, by the lever rule.
struct Balance {
    real T, liquid;
};
Balance lever(const RunRecord& run, const Reference& ref) {
    const auto number = [&](const char* name) { return ref.number(name); };
    const real water = run.series("liquid_volume").y.front() / volume_of(run), ice = 1 - water;
    const real to_melting = water * number("c_liquid") * (number("warm") - number("melts"));  // [J/kg of all]
    const real to_warm = ice * number("c_solid") * (number("melts") - number("cold")), to_melt = ice * number("fusion");
    const real left = to_melting - to_warm;
    if (left >= to_melt) return {number("melts") + (left - to_melt) / number("c_liquid"), 1};
    if (left < 0 && -left > water * number("fusion")) return {number("melts") + (left + water * number("fusion")) / number("c_solid"), 0};
    return {number("melts"), water + left / number("fusion")};
}

real lever_temperature(const RunRecord& run, const Reference& ref) {
    const real T = lever(run, ref).T;
    real worst = 0;
    for (const real value : run.field("temperature").data[0]) worst = std::max(worst, std::abs(value - T));
    return worst / (ref.number("warm") - ref.number("cold"));
}

real lever_liquid(const RunRecord& run, const Reference& ref) {
    return std::abs(run.series("liquid_volume").y.back() / volume_of(run) - lever(run, ref).liquid);
}

Panel lever_panel(const RunRecord& run, const Reference& ref) {
    Curve share = run.series("liquid_volume");
    for (real& y : share.y)
        for (const real length : run.scene->root().numbers("grid.size")) y /= length;
    share.label = "weir";
    const real end = lever(run, ref).liquid;
    Curve rule{.label = fmt::format("lever rule, {:.4f}", end), .x = {0, run.time}, .y = {end, end}, .dashed = true};
    return {.title = "Share of liquid", .x = {"t [s]"}, .y = {"liquid"}, .curves = {rule, share}};
}

/// Heat − heat at the start − heat added at each moment, over the largest heat of any.
Curve unaccounted(const RunRecord& run) {
    const Curve heat = run.series("heat"), added = run.series("heat_added");
    Curve share{.label = "weir", .x = heat.x};
    real most = 0;
    for (std::size_t i = 0; i < heat.size(); ++i) {
        share.y.push_back(heat.y[i] - heat.y.front() - added.y[i]);
        most = std::max({most, std::abs(heat.y[i]), std::abs(added.y[i])});
    }
    for (real& y : share.y) y /= most;
    return share;
}

real balance_error(const RunRecord& run, const Reference&) {
    real worst = 0;
    for (const real y : unaccounted(run).y)
        if (!(std::abs(y) <= worst)) worst = std::abs(y);
    return worst;
}

Panel balance_panel(const RunRecord& run, const Reference&) {
    return {.title = "Heat that nothing accounts for", .x = {"t [s]"}, .y = {"of the largest heat"}, .curves = {unaccounted(run)}};
}

/// Temperatures of the first row of cells, along x.
Curve first_row(const RunRecord& run) {
    const auto& T = needed_field(run.fields, "", "temperature").data[0];
    const auto& grid = run.fields.grid;
    Curve row{.label = "weir"};
    for (int i = 0; i < grid.cells[0]; ++i)
        row.x.push_back(grid.origin[0] + (i + 0.5) * grid.spacing[0]), row.y.push_back(T[static_cast<std::size_t>(i)]);
    return row;
}

/// Root mean square over cells, over the difference of both halves.
real contact_profile(const RunRecord& run, const Reference& ref) {
    const Curve row = first_row(run);
    const auto exact = ref.scalars.at("temperature");
    real sum = 0;
    for (std::size_t i = 0; i < row.size(); ++i) sum += std::pow(row.y[i] - exact({row.x[i], 0, 0}, run.time), 2);
    return std::sqrt(sum / static_cast<real>(row.size())) / (ref.number("warm") - ref.number("cold"));
}

/// What both cells beside the contact say of it: the half cells pass the same heat on, as conductors in a row.
real contact_temperature(const RunRecord& run, const Reference& ref) {
    const Curve row = first_row(run);
    const std::size_t right = row.size() / 2;
    const real k_solid = run.scene->number("substance.solid.conductivity"), k_liquid = run.scene->number("substance.liquid.conductivity");
    const real T = (k_solid * row.y[right - 1] + k_liquid * row.y[right]) / (k_solid + k_liquid);
    return std::abs(T - ref.number("contact")) / (ref.number("warm") - ref.number("cold"));
}

Panel contact_panel(const RunRecord& run, const Reference& ref) {
    const auto temperature = ref.scalars.at("temperature");
    Curve exact{.label = fmt::format("exact, contact at {:.3f} K", ref.number("contact")), .points = true};
    const real length = run.fields.grid.spacing[0] * run.fields.grid.cells[0];
    for (int i = 0; i <= 40; ++i) {
        exact.x.push_back(length * i / 40);
        exact.y.push_back(temperature({exact.x.back(), 0, 0}, run.time));
    }
    return {.title = "Two half spaces in contact", .x = {"x [m]"}, .y = {"T [K]"}, .curves = {exact, first_row(run)}};
}

/// Largest difference of any cell's temperature at the end from the one that it began with.
real return_error(const RunRecord& run, const Reference&) {
    const real began = run.scene->number("initial.temperature.value");
    real worst = 0;
    for (const real T : run.field("temperature").data[0]) worst = std::max(worst, std::abs(T / began - 1));
    return worst;
}

/// Of a wave of one period along x, by projection.
real amplitude(const FieldSet& fields) {
    const FieldView& x = needed_field(fields, "particles", "position");
    const auto& T = needed_field(fields, "particles", "temperature").data[0];
    const real k = 2 * pi / (fields.grid.spacing[0] * fields.grid.cells[0]);
    real sum = 0;
    for (std::size_t i = 0; i < T.size(); ++i) sum += T[i] * std::sin(k * (x.data[0][i] - fields.grid.origin[0]));
    return 2 * sum / static_cast<real>(T.size());
}

/// How far the rate at which it decays is from that of the heat equation, relative.
real decay_error(const RunRecord& run, const Reference& ref) {
    const Curve a = run.series("sine.decay_error");
    return std::abs(std::log(a.y.front() / a.y.back()) / (ref.number("rate") * run.time) - 1);
}

/// Largest difference of any particle from the steady temperatures of a slab of ice and water, over that of its two sides.
real slab_error(const RunRecord& run, const Reference& ref) {
    const FieldView& x = needed_field(run.fields, "particles", "position");
    const auto& T = needed_field(run.fields, "particles", "temperature").data[0];
    const auto exact = ref.scalars.at("temperature");
    real worst = 0;
    for (std::size_t i = 0; i < T.size(); ++i) worst = std::max(worst, std::abs(T[i] - exact({x.data[0][i], 0, 0}, run.time)));
    return worst / ref.number("difference");
}

}  // namespace

std::vector<Metric> melting_metrics() {
    return {
        {.name = "stefan.front_error",
         .unit = "",
         .doc = "How far the front is from the exact one at the end, relative.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return std::abs(front(run).y.back() / exact_front(ref, run.time) - 1); },
         .figure = front_panel},
        {.name = "stefan.mean_front_error",
         .unit = "",
         .doc = "How far the front is from the exact one over the second half of the run in the mean, relative.",
         .measure = mean_front_error,
         .figure = front_panel},
        {.name = "lever.temperature_error",
         .unit = "",
         .doc = "Largest difference of the temperature at the end from the lever rule's, over that of ice and water at the start.",
         .measure = lever_temperature},
        {.name = "lever.liquid_error",
         .unit = "",
         .doc = "How far the share of liquid at the end is from the lever rule's.",
         .measure = lever_liquid,
         .figure = lever_panel},
        {.name = "heat.balance_error",
         .unit = "",
         .doc = "Largest difference between the heat in the box and what was there and was added, over the largest heat.",
         .measure = balance_error,
         .figure = balance_panel},
        {.name = "sine.decay_error",
         .unit = "",
         .doc = "How far the rate at which a wave of temperature decays is from that of the heat equation, relative.",
         .measure = decay_error,
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return amplitude(fields); }},
        {.name = "slab.temperature_error",
         .unit = "",
         .doc = "Largest difference from the steady temperature of a slab of two conductivities, over that of its two sides.",
         .measure = slab_error},
        {.name = "contact.profile_error",
         .unit = "",
         .doc = "Root mean square of the difference from the exact temperatures of two half spaces in contact, over theirs at the start.",
         .measure = contact_profile,
         .figure = contact_panel},
        {.name = "contact.temperature_error",
         .unit = "",
         .doc = "How far the temperature of the contact is from that of both effusivities, over the difference at the start.",
         .measure = contact_temperature},
        {.name = "heat.return_error",
         .unit = "",
         .doc = "Largest relative difference of the temperature at the end from the uniform one at the start.",
         .measure = return_error},
    };
}

}  // namespace weir::validation
