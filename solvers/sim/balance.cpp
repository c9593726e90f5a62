#include "sim/balance.hpp"

#include "parallel/communicator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

namespace weir::sim {

namespace {

constexpr real tolerated = 0.01;  // of volume, mass, energy or heat: a larger part gives a warning

const Integral* find(const std::vector<Integral>& list, std::string_view name) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const Integral& i) { return i.name == name; });
    return at == list.end() ? nullptr : &*at;
}

real value_or_zero(const std::vector<Integral>& list, std::string_view name) {
    const Integral* found = find(list, name);
    return found ? found->value : 0;
}

std::string side_kind(const scene::Scene& scene, const char* side) {
    return scene.root().text_or(std::string("sides.") + side + ".kind", "wall");
}

constexpr std::array side_names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

bool solids_move(const scene::Scene& scene) {
    const auto& solids = scene.root().tables("solids");
    return std::any_of(solids.begin(), solids.end(), [](const scene::Table& solid) { return solid.has("motion"); });
}

/// Returns whether an effect adds no energy: it dissipates or transfers energy only.
bool is_harmless(const std::string& effect) {
    constexpr std::array list{"gravity",           "viscosity",    "volume_control", "xsph",   "artificial_viscosity",
                              "density_diffusion", "rest_density", "friction",       "damping"};
    return std::find(list.begin(), list.end(), effect) != list.end();
}

/// Lower bound of the fluid's potential energy in the domain: all mass in the lowest corner.
real lowest_energy(const scene::Scene& scene, const GridView& grid, const std::vector<Integral>& start) {
    const scene::Table* gravity = scene.effect("gravity");
    if (!gravity || !gravity->has("g")) return 0;
    const auto& g = gravity->numbers("g");
    real lowest = 0;
    for (std::size_t d = 0; d < g.size() && d < 3; ++d) lowest += std::min(0.0, -g[d] * grid.spacing[d] * grid.cells[d]);
    const Integral* mass = find(start, "mass");
    return lowest * (mass ? mass->value : scene.root().number_or("fluid.density", 1000) * value_or_zero(start, "volume"));
}

/// Net inflow that the solver recorded since the start; no value where it is not recorded.
std::optional<real> inflow_of_volume(const scene::Scene& scene, const std::vector<Integral>& start, const std::vector<Integral>& end) {
    for (const char* balance : {"volume_target", "poured_volume"})
        if (const Integral* before = find(start, balance), *after = find(end, balance); before && after)
            return after->value - before->value;
    return is_closed(scene) ? std::optional<real>(0) : std::nullopt;
}

std::optional<Balanced> balanced(const std::string& name, const std::vector<Integral>& start, const std::vector<Integral>& end) {
    const Integral *before = find(start, name), *after = find(end, name);
    if (!before || !after) return std::nullopt;
    return Balanced{.name = name,
                    .unit = after->unit,
                    .start = before->value,
                    .end = after->value,
                    .inflow = {},
                    .unexplained = {},
                    .scale = std::abs(before->value),
                    .highest = {},
                    .furthest = {}};
}

void explain(Balanced& b, real scale) {
    b.scale = scale;
    if (b.inflow && scale > 0) b.unexplained = (b.end - b.start - *b.inflow) / scale;
}

std::optional<Balanced> volume(const scene::Scene& scene, const std::vector<Integral>& start, const std::vector<Integral>& end) {
    const bool particles = find(end, "mass") != nullptr;  // the volume of particles is their mass over the density
    auto b = balanced(particles ? "mass" : "volume", start, end);
    if (!b) return b;
    if (!particles)
        b->inflow = inflow_of_volume(scene, start, end);
    else if (is_closed(scene))
        b->inflow = 0;
    explain(*b, std::max(b->start, b->start + b->inflow.value_or(0)));
    return b;
}

std::optional<Balanced> heat(const scene::Scene& scene, const std::vector<Integral>& start, const std::vector<Integral>& end) {
    auto b = balanced("heat", start, end);
    const Integral *before = find(start, "heat_added"), *after = find(end, "heat_added");
    if (!b || !before || !after) return b;
    const real vapour = value_or_zero(end, "vapour_heat") - value_or_zero(start, "vapour_heat");
    const real added = after->value - before->value - vapour;
    const Integral *poured_before = find(start, "poured_heat"), *poured = find(end, "poured_heat");
    if (poured_before && poured)
        b->inflow = added + (poured->value - poured_before->value);
    else if (is_closed(scene))
        b->inflow = added;
    explain(*b, std::max({std::abs(b->start), std::abs(b->end), std::abs(b->inflow.value_or(added))}));
    return b;
}

std::string what_helps(const scene::Scene& scene) {
    if (scene.solver() == "mac_water" || scene.solver() == "tallcell")
        return scene.effect("volume_control") ? "refine the grid" : "refine the grid, or add effects.volume_control";
    return "refine the grid, or shorten the steps (time.cfl)";
}

void warn_of_quantity(const scene::Scene& scene, const Balanced& b, std::vector<std::string>& warnings) {
    if (!b.unexplained || !(std::abs(*b.unexplained) > tolerated)) return;
    const std::string name = b.name == "heat" ? "the fluid's heat" : "the liquid's " + b.name;
    const std::string from_to = fmt::format("{:.4g} {} to {:.4g} {}", b.start, b.unit, b.end, b.unit);
    const bool exchanged = std::abs(*b.inflow) > 1e-9 * b.scale;
    const std::string text =
        exchanged ? fmt::format("{} is {} {} the value expected from inflow and outflow ({}, net inflow {:.4g} {})", name,
                                percent_text(std::abs(*b.unexplained)), *b.unexplained < 0 ? "below" : "above", from_to, *b.inflow, b.unit)
                  : fmt::format("{} {} by {} without an {} ({})", name, *b.unexplained < 0 ? "fell" : "rose",
                                percent_text(std::abs(*b.unexplained)), *b.unexplained < 0 ? "outlet" : "inlet", from_to);
    warnings.push_back(text + "; " + what_helps(scene));
}

void warn_of_energy(const Balanced& b, std::vector<std::string>& warnings) {
    if (!b.unexplained || !(*b.unexplained > tolerated)) return;
    warnings.push_back(
        fmt::format("the total energy rose by {} above its initial value, although nothing does work on the fluid ({:.4g} {} to {:.4g} "
                    "{}); refine the grid, or shorten the steps (time.cfl)",
                    percent_text(std::abs(*b.unexplained)), b.start, b.unit, *b.highest, b.unit));
}

/// What keeps the volume beside moving solids is taken from the surface there, that of trapped gas too.
void warn_of_corrections(const std::vector<Integral>& corrected, const std::vector<Integral>& end, std::vector<std::string>& warnings) {
    const Integral* moved = find(corrected, "volume_corrections");
    const real volume = value_or_zero(end, "volume");
    if (!moved || !(moved->value > tolerated * volume)) return;
    warnings.push_back(
        fmt::format("{} of the liquid was moved along its surface to keep the volume beside moving solids ({:.4g} {}): "
                    "trapped gas may have changed by a part of that; refine the grid",
                    percent_text(moved->value / volume), moved->value, moved->unit));
}

/// Pockets of enclosed air.
std::vector<Integral> enclosed_air(const std::vector<Integral>& end) {
    std::vector<Integral> list;
    for (const char* name : {"air_pockets", "largest_pocket_volume", "largest_pocket_pressure"})
        if (const Integral* now = find(end, name)) list.push_back(*now);
    return list;
}

/// Corrections applied to the fluid, counted since the start.
std::vector<Integral> corrections(const std::vector<Integral>& start, const std::vector<Integral>& end) {
    std::vector<Integral> list;
    for (const char* name : {"escaped_markers", "reseeded_markers", "clamped", "raised_depth", "volume_shift", "volume_corrections",
                             "smoke_removed", "smoke_continued"})
        if (const Integral* now = find(end, name)) list.push_back({name, now->unit, now->value - value_or_zero(start, name)});
    return list;
}

real least_side(const std::vector<double>& min, const std::vector<double>& max, const GridView& grid) {
    real least = infinity;
    for (std::size_t d = 0; d < min.size() && d < 3; ++d) least = std::min(least, (max[d] - min[d]) / grid.spacing[d]);
    return least;
}

/// In cells; infinite where the shape has no unique thickness.
real thickness(const scene::Table& solid, const GridView& grid) {
    const std::string shape = solid.text("shape");
    real cell = 0;
    for (int a = 0; a < grid.dim; ++a) cell = std::max(cell, grid.spacing[static_cast<std::size_t>(a)]);
    if (shape == "box") return least_side(solid.numbers("min"), solid.numbers("max"), grid);
    if (shape == "sphere" || shape == "capsule") return 2 * solid.number("radius") / cell;
    if (shape != "cylinder") return infinity;
    return std::min(2 * solid.number("radius"), norm(solid.vec<3>("to") - solid.vec<3>("from"))) / cell;
}

}  // namespace

std::optional<real> total_energy(const std::vector<Integral>& integrals) {
    if (!find(integrals, "kinetic_energy")) return std::nullopt;
    real sum = 0;
    for (const char* part : {"kinetic_energy", "potential_energy", "elastic_energy", "bodies_kinetic_energy", "bodies_potential_energy"})
        sum += value_or_zero(integrals, part);
    return sum;
}

bool is_closed(const scene::Scene& scene) {
    for (const char* sources : {"emitters", "sinks"})
        if (!scene.root().tables(sources).empty()) return false;
    if (scene.effect("hand") || scene.effect("rain")) return false;
    return std::all_of(side_names.begin(), side_names.end(), [&](const char* side) {
        const std::string kind = side_kind(scene, side);
        return kind == "wall" || kind == "moving_wall" || kind == "periodic";
    });
}

bool energy_cannot_grow(const scene::Scene& scene) {
    if (!is_closed(scene) || solids_move(scene) || scene.has("substance") || !scene.root().tables("changes").empty()) return false;
    if (!scene.root().tables("joints").empty()) return false;  // springs and motors
    for (const char* side : side_names)
        if (side_kind(scene, side) == "moving_wall") return false;
    if (!scene.has("effects")) return true;
    const auto effects = scene.root().table("effects").keys();
    return std::all_of(effects.begin(), effects.end(), is_harmless);
}

std::string percent_text(real part) {
    const real value = 100 * part, size = std::abs(value);
    if (!(size > 0) || !(size < 10)) return fmt::format("{:.0f}%", value);
    std::string text = fmt::format("{:.{}f}", value, static_cast<int>(std::ceil(1 - std::log10(size))));
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text + '%';
}

std::vector<std::pair<std::string, real>> thin_solids(const scene::Scene& scene, const GridView& grid) {
    constexpr real resolved = 2;  // cells
    std::vector<std::pair<std::string, real>> list;
    const auto& solids = scene.root().tables("solids");
    for (std::size_t i = 0; i < solids.size(); ++i)
        if (const real cells = thickness(solids[i], grid); cells < resolved * (1 - 1e-9))
            list.emplace_back("solids[" + std::to_string(i) + "]", cells);
    return list;
}

Balance::Balance(const Simulation& simulation) : from_(simulation.time()), start_(simulation.integrals()) {
    if (const auto energy = total_energy(start_)) highest_energy_ = *energy;
}

void Balance::on_step(const Simulation& simulation, const StepReport& report) {
    if (++steps_ % steps_between == 0 && !communicator().several()) on_frame(simulation);
    if (std::isnan(report.max_divergence)) return;
    divergence_ = std::fmax(divergence_, report.max_divergence);
    cell_change_ = std::fmax(cell_change_, report.max_divergence * report.dt);
}

void Balance::on_frame(const Simulation& simulation) {
    const std::vector<Integral> now = simulation.integrals();
    if (const auto energy = total_energy(now)) highest_energy_ = std::max(highest_energy_, *energy);
    if (const auto b = volume(simulation.scene(), start_, now);
        b && b->unexplained && std::abs(*b->unexplained) > std::abs(furthest_drift_))
        furthest_drift_ = *b->unexplained;
}

BalanceOfRun Balance::of_run(const Simulation& simulation) const {
    const scene::Scene& scene = simulation.scene();
    const std::vector<Integral> end = simulation.integrals();
    const GridView grid = simulation.fields().grid;
    BalanceOfRun run{.from = from_,
                     .to = simulation.time(),
                     .quantities = {},
                     .corrected = corrections(start_, end),
                     .air = enclosed_air(end),
                     .divergence = divergence_,
                     .cell_change = cell_change_,
                     .thin = {},
                     .warnings = {}};
    if (auto b = volume(scene, start_, end)) {
        if (b->unexplained) b->furthest = std::abs(*b->unexplained) > std::abs(furthest_drift_) ? *b->unexplained : furthest_drift_;
        warn_of_quantity(scene, *b, run.warnings);
        run.quantities.push_back(std::move(*b));
    }
    if (const auto before = total_energy(start_), after = total_energy(end); before && after) {
        Balanced b{.name = "energy",
                   .unit = find(end, "kinetic_energy")->unit,
                   .start = *before,
                   .end = *after,
                   .inflow = {},
                   .unexplained = {},
                   .scale = std::max(*before - lowest_energy(scene, grid, start_), std::abs(*before)),
                   .highest = std::max(highest_energy_, *after),
                   .furthest = {}};
        const bool whole = !find(end, "bodies_kinetic_energy") || find(end, "potential_energy");  // with bodies: of displaced fluid
        if (whole && b.scale > 0 && energy_cannot_grow(scene)) b.unexplained = (*b.highest - b.start) / b.scale;
        warn_of_energy(b, run.warnings);
        run.quantities.push_back(std::move(b));
    }
    if (auto b = heat(scene, start_, end)) {
        warn_of_quantity(scene, *b, run.warnings);
        run.quantities.push_back(std::move(*b));
    }
    for (const char* name : {"total_smoke", "total_tracer"})
        if (auto b = balanced(name, start_, end)) run.quantities.push_back(std::move(*b));
    warn_of_corrections(run.corrected, end, run.warnings);
    if (!find(end, "particles")) run.thin = thin_solids(scene, grid);
    return run;
}

}  // namespace weir::sim
