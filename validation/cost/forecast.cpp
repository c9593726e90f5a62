#include "validation/cost/forecast.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "sim/simulation.hpp"
#include "validation/cost/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <tuple>

namespace weir::validation {
namespace {

constexpr int untimed_steps = 2, most_steps = 25, fewest_steps = 5;
constexpr double enough = 0.6;        // seconds for one copy
constexpr double fewest_units = 100;  // of a copy: with fewer, what a step costs whatever its size says too much

std::string cells_text(const scene::Scene& scene) { return fmt::format("{}", fmt::join(scene.root().numbers("grid.cells"), " x ")); }

/// Particles where they are what the solver consists of, else cells.
std::pair<double, bool> count_of(const scene::Scene& scene, const FieldSet& fields) {
    if (const FieldView* x = fields.find("particles", "position")) return {static_cast<double>(x->data[0].size()), true};
    double cells = 1;
    for (const double n : scene.root().numbers("grid.cells")) cells *= n;
    return {cells, false};
}

double wall_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double median(std::vector<double> list) {
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::nth_element(list.begin(), middle, list.end());
    return *middle;
}

/// The scene with each axis divided by `by`, where that leaves whole numbers of cells.
std::optional<scene::Scene> coarser(const scene::Scene& scene, int by, const std::vector<scene::SolverSchema>& schemas) {
    std::vector<std::string> cells;
    for (const double n : scene.root().numbers("grid.cells")) {
        if (std::fmod(n, by) != 0 || n / by < 4) return std::nullopt;
        cells.push_back(fmt::format("{:.0f}", n / by));
    }
    auto overrides = scene.overrides();
    overrides.push_back({"grid.cells", fmt::format("[{}]", fmt::join(cells, ", "))});
    try {
        return scene::parse(scene.source(), scene.file(), schemas, overrides);
    } catch (const BadInput&) {
        return std::nullopt;
    }
}

/// The finest copies first, each at least a factor 1.5 coarser than the one before.
std::vector<Rates> measure_copies(const scene::Scene& scene, double units, const std::vector<scene::SolverKind>& kinds) {
    std::vector<Rates> list;
    const auto schemas = scene::schemas_of(kinds);
    double last = 1;
    for (int by = 2; list.size() < 2 && units / std::pow(by, scene.dim()) >= fewest_units; ++by) {
        if (by < 1.5 * last) continue;
        const auto copy = coarser(scene, by, schemas);
        if (!copy) continue;
        try {
            list.push_back(measure_rates(*copy, kinds, enough));
            last = by;
        } catch (const std::runtime_error&) {  // what fits the scene may not fit its copy: no liquid in so few cells, say
        }
    }
    if (list.size() < 2) list = {measure_rates(scene, kinds, enough)};
    return list;
}

/// y at size n, by the power of the size that two copies show, kept to what steps do: not less than `low`, not more than `high`.
double scaled(double n, const std::vector<Rates>& at, double y0, double y1, double low, double high) {
    if (at.size() < 2 || !(y0 > 0 && y1 > 0)) return y0;
    const double power = std::log(y0 / y1) / std::log(at[0].count / at[1].count);
    return y0 * std::pow(n / at[0].count, std::clamp(power, low, high));
}

double seconds_of(const Rates& r, const std::string& pass) {
    for (const Pass& p : r.passes)
        if (p.name == pass) return p.seconds;
    return 0;
}

}  // namespace

Rates measure_rates(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double enough_seconds) {
    Simulation simulation(scene, kinds);
    Rates r{.cells = cells_text(scene)};
    r.count = count_of(scene, simulation.fields()).first;
    std::vector<double> seconds;
    double spent = 0, simulated = 0, on_the_wall = 0;
    for (int i = -untimed_steps; i < most_steps && (i < fewest_steps || spent < enough_seconds) && !simulation.finished(); ++i) {
        if (i == 0) simulation.solver().passes().reset();
        const double start = computing_seconds(), wall = wall_seconds();
        const real dt = simulation.step().dt;
        const double took = computing_seconds() - start;
        if (i < 0) continue;
        on_the_wall += wall_seconds() - wall;
        seconds.push_back(took);
        spent += took, simulated += dt;
    }
    if (seconds.empty()) throw NumericalFailure("time", "the scene ends before a step can be measured");
    r.ms = 1e3 * median(seconds);
    r.dt = simulated / static_cast<double>(seconds.size());
    r.passes = simulation.solver().passes().list();
    double inside = 0;
    for (const Pass& p : r.passes) inside += p.seconds;
    r.passes.push_back({"outside passes", 0, std::max(0.0, on_the_wall - inside)});
    for (Pass& p : r.passes) p.seconds *= 1e-3 * r.ms / std::max(on_the_wall, inside);
    return r;
}

Forecast forecast(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    static constexpr const char* places[] = {"cells", "faces", "particles"};
    Simulation simulation(scene, kinds);
    Forecast f{.solver = scene.solver(), .dim = scene.dim(), .cells = cells_text(scene)};
    const FieldSet set = simulation.fields();  // as the scene starts
    for (const FieldView& field : set.fields) {
        std::size_t values = 0;
        for (const auto& component : field.data) values += component.size();
        f.fields.push_back({field.name, field.unit, places[static_cast<std::size_t>(field.where)], values * sizeof(real)});
    }
    std::tie(f.count, f.particles) = count_of(scene, set);
    f.effects = simulation.solver().effects();
    f.bytes = simulation.solver().bytes();
    simulation.step();
    f.bytes_moving = simulation.solver().bytes();
    f.measured = measure_copies(scene, f.count, kinds);
    const auto& at = f.measured;
    const Rates &fine = at.front(), &coarse = at.back();
    // a step looks at everything once, and a solve may take more iterations on more cells; small steps have costs of their own
    f.ms = scaled(f.count, at, fine.ms, coarse.ms, 0.5, 1.4);
    f.dt = scaled(f.count, at, fine.dt, coarse.dt, -2.0 / f.dim, 0);
    double total = 0;
    for (const Pass& p : fine.passes) {
        f.passes.push_back({p.name, 0, scaled(f.count, at, p.seconds, seconds_of(coarse, p.name), 0.3, 1.6)});
        total += f.passes.back().seconds;
    }
    for (Pass& p : f.passes) p.seconds *= 1e-3 * f.ms / total;
    return f;
}

std::string forecast_text(const Forecast& f, const scene::Scene& scene) {
    const auto megabytes = [](double bytes) { return fmt::format("{:.4g} MB", bytes / 1e6); };
    const char* unit = f.particles ? "particle" : "cell";
    std::string s = fmt::format("{}, {}D, {} cells", f.solver, f.dim, f.cells);
    if (f.particles) s += fmt::format(", {:.0f} particles", f.count);
    s += "\nfields\n";
    for (const PlannedField& field : f.fields)
        s += fmt::format("  {:22} {:9} {:>10}\n", field.unit.empty() ? field.name : field.name + " [" + field.unit + "]", field.where,
                         megabytes(static_cast<double>(field.bytes)));
    const auto each = [&](std::size_t bytes) { return static_cast<double>(bytes) / f.count; };
    s += fmt::format("memory\n  {} bytes as it starts, {:.1f} a {}\n", f.bytes, each(f.bytes), unit);
    s += fmt::format("  {} bytes after its first step, {:.1f} a {}; lists grow with what moves\neffects\n", f.bytes_moving,
                     each(f.bytes_moving), unit);
    for (const EffectPlan& e : f.effects)
        s += fmt::format("  {:22} {}\n", e.name, e.pass.empty() ? "a term of \"" + e.inside + "\"" : "\"" + e.pass + "\"");
    if (f.effects.empty()) s += "  none\n";
    s += fmt::format("a step, {} thread(s)\n", threads());
    for (const Pass& p : f.passes)
        if (p.seconds > 0)
            s += fmt::format("  {:22} {:9.3f} ms  {:8.2f} ns a {}\n", p.name, 1e3 * p.seconds, 1e9 * p.seconds / f.count, unit);
    s += fmt::format("  {:22} {:9.3f} ms  {:8.2f} ns a {}\n", "all", f.ms, 1e6 * f.ms / f.count, unit);
    const double dt = scene.has("time.dt") ? scene.number("time.dt") : std::min(f.dt, scene.root().number_or("time.max_dt", infinity));
    const double steps = std::ceil(scene.number("time.end") / dt);
    s += fmt::format("the whole scene, if it went on as it begins\n  {:.0f} steps of {:.3g} s, {:.3g} s of computing\n", steps, dt,
                     1e-3 * steps * f.ms);
    s += "rates measured now, in the first steps of";
    for (const Rates& r : f.measured) s += fmt::format("{} {} cells ({:.3g} ms)", &r == &f.measured.front() ? "" : " and", r.cells, r.ms);
    return s + (f.measured.size() < 2 ? ": the scene itself, which has no coarser copies\n" : ": coarser copies of the scene\n");
}

}  // namespace weir::validation
