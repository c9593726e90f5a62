#include "validation/cost/cost_estimate.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "sim/loop.hpp"
#include "sim/simulation.hpp"
#include "sim/small_copy.hpp"
#include "validation/cost/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <tuple>

namespace weir::validation {
namespace {

constexpr int untimed_steps = 2, most_steps = 400, fewest_steps = 5;
constexpr double enough = 0.6;        // seconds for one copy
constexpr double largest = 65536;     // units of a copy, or of a scene that is measured itself: some tenths of a second to build
constexpr double fewest_units = 100;  // of a copy: with fewer, what a step costs whatever its size says too much

std::string cells_text(const scene::Scene& scene) { return fmt::format("{}", fmt::join(scene.root().numbers("grid.cells"), " x ")); }

/// Particles where they are what the solver consists of, else cells.
std::pair<double, bool> count_of(const scene::Scene& scene, const FieldSet& fields) {
    if (const FieldView* x = fields.find("particles", "position")) return {static_cast<double>(x->data[0].size()), true};
    double cells = 1;
    for (const double n : scene.root().numbers("grid.cells")) cells *= n;
    return {cells, false};
}

double median(std::vector<double> list) {
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::nth_element(list.begin(), middle, list.end());
    return *middle;
}

/// How many times coarser a copy is along each axis: a ratio, so that cells stay whole.
struct Coarser {
    int times, over;
    double by() const { return static_cast<double>(times) / over; }
};
/// 4/3, 3/2, 2, 3, 4, ..
Coarser coarser(int number) { return number == 0 ? Coarser{4, 3} : number == 1 ? Coarser{3, 2} : Coarser{number, 1}; }

/// The scene so many times coarser along each axis, where that leaves whole numbers of cells.
std::optional<scene::Scene> divided(const scene::Scene& scene, const Coarser& part, const std::vector<scene::SolverSchema>& schemas) {
    std::vector<std::string> cells;
    for (const double n : scene.root().numbers("grid.cells")) {
        if (n != 1 && (std::fmod(n * part.over, part.times) != 0 || n / part.by() < 4)) return std::nullopt;  // 1: columns
        cells.push_back(fmt::format("{:.0f}", n == 1 ? n : n / part.by()));
    }
    auto overrides = scene.overrides();
    overrides.push_back({"grid.cells", fmt::format("[{}]", fmt::join(cells, ", "))});
    try {
        return scene::parse(scene.source(), scene.file(), schemas, overrides);
    } catch (const BadInput&) {
        return std::nullopt;
    }
}

/// Measures a copy, or does not: what fits the scene may not fit its copy (no liquid in so few cells, say).
bool measure_copy(const scene::Scene& copy, const std::vector<scene::SolverKind>& kinds, std::vector<Rates>& list) {
    try {
        list.push_back(measure_rates(copy, kinds, enough));
        return true;
    } catch (const std::runtime_error&) {
        return false;
    }
}

/// The finest copies first, each at least a factor 1.5 coarser than the one before; none with more units than `largest`.
std::vector<Rates> measure_copies(const scene::Scene& scene, double units, const std::vector<scene::SolverKind>& kinds) {
    const auto schemas = scene::schemas_of(kinds);
    const auto part = [&](double by) { return units / std::pow(by, scene.dim()); };
    std::vector<Rates> list;
    double last = 0;
    for (int number = 0; list.size() < 2 && part(coarser(number).by()) >= fewest_units; ++number) {
        const double by = coarser(number).by();
        if (by < 1.5 * last || part(by) > largest) continue;
        const auto copy = divided(scene, coarser(number), schemas);
        if (copy && measure_copy(*copy, kinds, list)) last = by;
    }
    if (list.size() == 2 || units <= largest) return list.size() == 2 ? list : std::vector<Rates>{measure_rates(scene, kinds, enough)};
    list.clear();  // cells that no number divides: copies in about these proportions
    double cells = 1;
    for (const double n : scene.root().numbers("grid.cells")) cells *= n;
    for (const double share : {1.0, 0.25})
        measure_copy(sim::small_copy(scene, kinds, share * largest * cells / units, sim::Copy::similar), kinds, list);
    if (list.empty()) throw NumericalFailure("time", "no coarser copy of this scene completes a step, so no time per step can be measured");
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
    const sim::NoThreadTrials no_trials;
    Simulation simulation(scene, kinds);
    Rates r{.cells = cells_text(scene)};
    r.count = count_of(scene, simulation.fields()).first;
    std::vector<double> seconds;
    double spent = 0, simulated = 0, on_the_wall = 0;
    sim::advance(simulation, {.steps = untimed_steps, .past_end = true});  // past its end where it is one step
    simulation.solver().passes().reset();
    double start = computing_seconds();
    sim::advance(simulation, {.steps = most_steps, .past_end = true}, [&](const StepReport& step, double wall) {
        const real dt = step.dt;
        const double took = computing_seconds() - start;
        on_the_wall += wall;
        seconds.push_back(took);
        r.least_dt = seconds.size() == 1 ? dt : std::min(r.least_dt, dt), r.most_dt = std::max(r.most_dt, dt);
        spent += took, simulated += dt;
        r.iterations += step.iterations, r.viscous_iterations += step.viscous_iterations;
        if (step.cfl > r.most_cfl) r.most_cfl = step.cfl;
        start = computing_seconds();
        return std::ssize(seconds) < fewest_steps || (spent < enough_seconds && !simulation.finished());
    });
    if (seconds.empty()) throw NumericalFailure("time", "the scene ends before a step can be measured");
    r.ms = 1e3 * median(seconds);
    r.dt = simulated / static_cast<double>(seconds.size());
    r.iterations /= static_cast<double>(seconds.size()), r.viscous_iterations /= static_cast<double>(seconds.size());
    r.passes = simulation.solver().passes().list();
    double inside = 0;
    for (const Pass& p : r.passes) inside += p.seconds;
    r.passes.push_back({"outside passes", 0, std::max(0.0, on_the_wall - inside)});
    for (Pass& p : r.passes) p.seconds *= 1e-3 * r.ms / std::max(on_the_wall, inside);
    return r;
}

CostEstimate estimate_cost(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    CostEstimate f{.solver = scene.solver(), .dim = scene.dim(), .cells = cells_text(scene), .held = sim::estimate_memory(scene, kinds)};
    f.particles = f.held.particle_solver;
    f.count = f.particles ? f.held.particles : f.held.cells;
    f.output = sim::estimate_output(scene, f.held);
    f.measured = measure_copies(scene, f.count, kinds);
    const auto& at = f.measured;
    const Rates &fine = at.front(), &coarse = at.back();
    // a step looks at everything once, and a solve may take more iterations on more cells; small steps have costs of their own
    f.ms = scaled(f.count, at, fine.ms, coarse.ms, 0.5, 1.4);
    f.dt = scaled(f.count, at, fine.dt, coarse.dt, -2.0 / f.dim, 0);
    f.least_dt = f.dt * fine.least_dt / fine.dt, f.most_dt = f.dt * fine.most_dt / fine.dt;
    f.iterations = fine.iterations, f.viscous_iterations = fine.viscous_iterations, f.most_cfl = fine.most_cfl;
    double total = 0;
    for (const Pass& p : fine.passes) {
        f.passes.push_back({p.name, 0, scaled(f.count, at, p.seconds, seconds_of(coarse, p.name), 0.3, 1.6)});
        total += f.passes.back().seconds;
    }
    for (Pass& p : f.passes) p.seconds *= 1e-3 * f.ms / total;
    return f;
}

namespace {

/// A scene that prescribes its step takes so many; else as many as between the longest and the shortest steps that the small runs took.
std::string steps_text(const CostEstimate& f, const scene::Scene& scene) {
    const double end = scene.number("time.end"), longest = scene.root().number_or("time.max_dt", infinity);
    const auto steps = [&](double dt) { return std::ceil(end / std::min(dt, longest) * (1 - 1e-9)); };
    const bool fixed = scene.has("time.dt");
    const double few = fixed ? steps(scene.number("time.dt")) : steps(f.most_dt), many = fixed ? few : steps(f.least_dt);
    const std::string heading = "the whole scene, extrapolated from its first steps\n";
    const double seconds = 1e-3 * f.ms;
    if (few == many) return heading + fmt::format("  {:.0f} steps, {:.3g} s of computing\n", few, few * seconds);
    return heading + fmt::format("  {:.0f} to {:.0f} steps, {:.3g} to {:.3g} s of computing\n", few, many, few * seconds, many * seconds);
}

}  // namespace

std::string cost_estimate_text(const CostEstimate& f, const scene::Scene& scene) {
    const auto megabytes = [](double bytes) { return fmt::format("{:.4g} MB", bytes / 1e6); };
    const char* unit = f.particles ? "particle" : "cell";
    std::string s = fmt::format("{}, {}D, {} cells", f.solver, f.dim, f.cells);
    if (f.particles) s += fmt::format(", {:.0f} particles", f.count);
    s += "\nfields\n";
    static constexpr const char* places[] = {"cells", "faces", "particles"};
    for (const sim::EstimatedField& field : f.held.fields)
        s += fmt::format("  {:22} {:9} {:>10}\n", field.unit.empty() ? field.name : field.name + " [" + field.unit + "]",
                         places[static_cast<std::size_t>(field.where)], megabytes(field.values * sizeof(real)));
    s += fmt::format(
        "memory\n  {} after its first step, {:.1f} bytes per {}{}\n", megabytes(f.held.bytes), f.held.bytes / f.count, unit,
        f.held.exact ? ", as allocated; lists of moving particles may grow" : ", estimated within 10% from coarser copies of the scene");
    s += fmt::format("  {} for a run that writes frames\n", megabytes(sim::bytes_of_run(scene, f.held, true)));
    s += fmt::format("frames\n  {:.0f} of {}, {} without compression\neffects\n", f.output.frames, megabytes(f.output.bytes_of_frame),
                     megabytes(f.output.bytes()));
    for (const EffectPlan& e : f.held.effects)
        s += fmt::format("  {:22} {}\n", e.name, e.pass.empty() ? "a term of \"" + e.inside + "\"" : "\"" + e.pass + "\"");
    if (f.held.effects.empty()) s += "  none\n";
    s += fmt::format("time per step, {} thread(s)\n", threads());
    for (const Pass& p : f.passes)
        if (p.seconds > 0)
            s += fmt::format("  {:22} {:9.3f} ms  {:8.2f} ns per {}\n", p.name, 1e3 * p.seconds, 1e9 * p.seconds / f.count, unit);
    s += fmt::format("  {:22} {:9.3f} ms  {:8.2f} ns per {}\n", "all", f.ms, 1e6 * f.ms / f.count, unit);
    s += steps_text(f, scene);
    s += "rates measured now, in the first steps of";
    for (const Rates& r : f.measured) s += fmt::format("{} {} cells ({:.3g} ms)", &r == &f.measured.front() ? "" : " and", r.cells, r.ms);
    return s + (f.measured.size() < 2 ? ": the scene itself, which has no coarser copies\n" : ": coarser copies of the scene\n");
}

}  // namespace weir::validation
