// Melting with natural convection: how much has melted, where the front stands, how many rolls turn in the melt.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Of the box.
real box_volume(const RunRecord& run) {
    real volume = 1;
    for (const real s : run.scene->root().numbers("grid.size")) volume *= s;
    return volume;
}

real melted_share(const RunRecord& run, const Reference&) { return run.series("liquid_volume").y.back() / box_volume(run); }

Panel melted_panel(const RunRecord& run, const Reference& ref) {
    Curve ours = run.series("liquid_volume");
    for (real& y : ours.y) y /= box_volume(run);
    for (real& x : ours.x) x /= 60;
    ours.label = "weir";
    Panel panel{.title = "The share that has melted", .x = {"t [min]"}, .y = {"share"}, .curves = {ours}};
    for (const char* name : {"share", "conduction"}) {
        Curve other = ref.curve(name);
        while (!other.x.empty() && other.x.back() * 60 > 1.5 * run.time) other.x.pop_back(), other.y.pop_back();
        if (other.size() > 0) panel.curves.push_back(other);
    }
    return panel;
}

/// x of the front at each row of cells: the liquid of the row.
Panel gallium_panel(const RunRecord& run, const Reference& ref) {
    const auto& liquid = needed_field(run.fields, "", "liquid");
    const auto& cells = run.scene->root().numbers("grid.cells");
    const auto& size = run.scene->root().numbers("grid.size");
    const int nx = static_cast<int>(cells[0]), ny = static_cast<int>(cells[1]);
    Curve ours{.label = "weir"};
    for (int j = 0; j < ny; ++j) {
        real sum = 0;
        for (int i = 0; i < nx; ++i) sum += liquid.data[0][static_cast<std::size_t>(i + nx * j)];
        ours.x.push_back(1e3 * sum * size[0] / nx), ours.y.push_back(1e3 * (j + 0.5) * size[1] / ny);
    }
    Panel panel{.title = "The front at the end", .x = {"x [mm]"}, .y = {"y [mm]"}, .curves = {ours}};
    const std::array<std::pair<const char*, real>, 3> stations = {{{"bottom", 0}, {"middle", 0.5}, {"top", 1}}};
    Curve measured{.label = ref.source, .points = true};
    for (const auto& [name, height] : stations) {
        const Curve& front = ref.curve(name);
        for (std::size_t i = 0; i < front.size(); ++i)
            if (std::abs(front.x[i] * 60 - run.time) < 1) measured.x.push_back(front.y[i]), measured.y.push_back(1e3 * height * size[1]);
    }
    if (measured.size() > 0) panel.curves.push_back(measured);
    return panel;
}

/// Extrema of the stream function, whose values are sums of u along y, that reach a twentieth of its largest magnitude.
real rolls(const RunRecord& run, const Reference&) {
    const auto& u = needed_field(run.fields, "", "velocity").data[0];
    const auto& cells = run.scene->root().numbers("grid.cells");
    const auto& size = run.scene->root().numbers("grid.size");
    const int nx = static_cast<int>(cells[0]), ny = static_cast<int>(cells[1]);
    std::vector<real> psi(static_cast<std::size_t>(nx * (ny + 1)), 0.0);
    const auto at = [&](int i, int j) -> real& { return psi[static_cast<std::size_t>(i + nx * j)]; };
    real most = 0;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            at(i, j + 1) = at(i, j) + u[static_cast<std::size_t>(i + nx * j)] * size[1] / ny;
            most = std::max(most, std::abs(at(i, j + 1)));
        }
    int count = 0;
    for (int j = 1; j < ny; ++j)
        for (int i = 1; i + 1 < nx; ++i) {
            const real here = std::abs(at(i, j)), sign = at(i, j) < 0 ? -1 : 1;
            bool highest = here > 0.05 * most;
            for (int dj = -1; dj <= 1; ++dj)
                for (int di = -1; di <= 1; ++di) highest = highest && (sign * at(i + di, j + dj) < here || (di == 0 && dj == 0));
            count += highest;
        }
    return count;
}

}  // namespace

std::vector<Metric> melting_convection_metrics() {
    return {
        {.name = "melting.share",
         .unit = "",
         .doc = "Liquid's share of the box at the end.",
         .measure = melted_share,
         .figure = melted_panel},
        {.name = "melting.rolls",
         .unit = "",
         .doc = "Rolls in the melt at the end: extrema of the stream function above a twentieth of the strongest.",
         .measure = rolls,
         .figure = gallium_panel},
    };
}

}  // namespace weir::validation
