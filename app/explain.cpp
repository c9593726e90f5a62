#include "app/explain.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "parallel/communicator.hpp"
#include "sim/loop.hpp"
#include "sim/registry.hpp"
#include "sim/shares.hpp"
#include "surfaces/reconstruction.hpp"
#include "validation/cost/parallel_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace weir::app {

namespace {

constexpr int warm_up_steps = 3, measured_steps = 20;

std::string megabytes(std::size_t bytes) { return fmt::format("{:.3g} MB", static_cast<double>(bytes) / 1e6); }

std::string called_for(const scene::Scene& scene, const scene::SolverSchema& schema) {
    std::string text = fmt::format("requested\n  solver      {}, {}D", schema.name, scene.dim());
    if (scene.has("grid.cells")) text += fmt::format(", {} cells", fmt::join(scene.root().numbers("grid.cells"), " x "));
    std::vector<std::string> effects;
    for (const auto& effect : schema.effects)
        if (scene.effect(effect.name)) effects.push_back(effect.name);
    text += fmt::format("\n  effects     {}\n", effects.empty() ? "none" : fmt::format("{}", fmt::join(effects, ", ")));
    for (const char* list : {"liquid", "solids", "bodies", "emitters", "sinks", "probes"})
        if (scene.has(list) && !scene.root().tables(list).empty())
            text += fmt::format("  {:10}  {}\n", list, scene.root().tables(list).size());
    return text;
}

std::string fields_text(const Simulation& simulation) {
    static constexpr const char* places[] = {"cells", "faces", "particles"};
    std::string text = "built\n";
    for (const FieldView& field : simulation.fields().fields) {
        std::size_t values = 0;
        for (const auto& component : field.data) values += component.size();
        text += fmt::format("  {:22} {:9} {:>12} values  {:>10}\n", field.unit.empty() ? field.name : field.name + " [" + field.unit + "]",
                            places[static_cast<std::size_t>(field.where)], values, megabytes(values * sizeof(real)));
    }
    return text +
           fmt::format("  {:22} {:9} {:>12}         {:>10}\n", "all state and scratch", "", "", megabytes(simulation.solver().bytes()));
}

std::string called(const EffectPlan& effect) {
    std::string text = effect.pass.empty()
                           ? fmt::format("a term of pass \"{}\"{}", effect.inside, effect.at_start ? ", through its coefficients only" : "")
                           : fmt::format("pass \"{}\"", effect.pass);
    if (!effect.fields.empty()) text += fmt::format("; fields {}", fmt::join(effect.fields, ", "));
    if (!effect.scratch.empty()) text += fmt::format("; scratch {}", fmt::join(effect.scratch, ", "));
    if (effect.bytes > 0) text += fmt::format("; {} of its own", megabytes(effect.bytes));
    return text;
}

/// What a step costs with the effect and without it: medians over interleaved rounds, so that what else the machine does
/// meets both. Used for effects that have no pass of their own to be timed by.
double share_by_difference(const scene::Scene& scene, const std::string& effect) {
    Simulation with(scene), without(scene.without_effect(effect));
    std::vector<double> ratios;
    const auto seconds = [](Simulation& s) {
        const auto start = std::chrono::steady_clock::now();
        if (!s.finished()) s.step();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    for (int i = 0; i < warm_up_steps + measured_steps && !with.finished() && !without.finished(); ++i) {
        const double a = seconds(with), b = seconds(without);
        if (i >= warm_up_steps) ratios.push_back(1 - b / a);
    }
    if (ratios.empty()) return 0;
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
    return ratios[ratios.size() / 2];
}

/// Each effect of the scene: what was built for it, and its part of a step.
std::string effects_text(const Simulation& simulation, const std::vector<Pass>& passes, double total, int steps) {
    std::string text;
    for (const EffectPlan& effect : simulation.solver().effects()) {
        const auto own = std::find_if(passes.begin(), passes.end(), [&](const Pass& p) { return p.name == effect.pass; });
        const bool timed = own != passes.end();
        double share = 0;
        try {
            share = timed ? own->seconds / total : share_by_difference(simulation.scene(), effect.name);
        } catch (const BadInput&) {  // what else the scene says needs it: no-slip sides, a viscosity
            text += fmt::format("  {:22} the scene is not valid without it\n", effect.name);
            continue;
        }
        text += fmt::format("  {:22} {:9.3f} ms {:5.1f}%{}  {}\n", effect.name, 1e3 * share * total / steps, 100 * share,
                            timed ? "" : " by difference", called(effect));
    }
    return text.empty() ? "" : "effects, of a step's time\n" + text;
}

/// Milliseconds per step of each pass, and its share.
std::string passes_text(Simulation& simulation) {
    sim::advance(simulation, {.steps = warm_up_steps});
    simulation.solver().passes().reset();
    const std::int64_t before = simulation.steps();
    sim::advance(simulation, {.steps = measured_steps});
    const int steps = static_cast<int>(simulation.steps() - before);
    auto passes = simulation.solver().passes().list();
    double total = 0;
    for (const Pass& pass : passes) total += pass.seconds;
    std::sort(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) { return a.seconds > b.seconds; });
    std::string text = fmt::format("time per step, mean of {} after the first {}, {} thread(s)\n", steps, warm_up_steps, threads());
    if (steps == 0) return "the scene ends before a step can be measured\n";
    for (const Pass& pass : passes)
        text += fmt::format("  {:22} {:9.3f} ms {:5.1f}%\n", pass.name, 1e3 * pass.seconds / steps, 100 * pass.seconds / total);
    text += fmt::format("  {:22} {:9.3f} ms\n", "all passes", 1e3 * total / steps);
    return text + effects_text(simulation, passes, total, steps);
}

/// What output.surface makes of a frame, and at what cost.
std::string surface_text(const Simulation& simulation) {
    const auto surface = surfaces::reconstruction_of(simulation.scene());
    if (!surface) return "";
    const auto parts = simulation.solver().distributed_view();
    const auto& mesh = surface->make_part(simulation.fields(), simulation.time());
    const std::size_t cells = begins_of_ranks(mesh.corners.size() + mesh.lines.size()).back();
    std::string text = fmt::format("surface reconstruction by {}, per frame\n", simulation.scene().text("output.surface.method"));
    for (const Pass& pass : surface->passes().list()) text += fmt::format("  {:22} {:9.3f} ms\n", pass.name, 1e3 * pass.seconds);
    return text + fmt::format("  {:22} {:9} {:>12} {} {:>8}\n", "all", "", cells, simulation.scene().dim() == 2 ? "lines" : "triangles",
                              megabytes(surface->bytes()));
}

std::string left_out(const scene::Scene& scene, const scene::SolverSchema& schema) {
    std::string text = "not requested: no field, no pass\n";
    bool any = false;
    for (const auto& effect : schema.effects)
        if (!scene.effect(effect.name)) text += fmt::format("  {:22} {}\n", effect.name, effect.doc), any = true;
    return any ? text : "";
}

}  // namespace

namespace {

/// What is wrong with the scene, or must be known of it, as it starts.
std::string concern_text(const Solver& solver) {
    const std::string concern = solver.concern();
    return concern.empty() ? "" : "  note        " + concern + "\n";
}

}  // namespace

std::string explain(Simulation& simulation) {
    const sim::NoThreadTrials no_trials;
    const scene::Scene& scene = simulation.scene();
    const scene::SolverSchema& schema = sim::kind_named(scene.solver()).schema;
    const std::string before =
        called_for(scene, schema) + concern_text(simulation.solver()) + fields_text(simulation);  // as the scene starts
    return before + passes_text(simulation) + surface_text(simulation) + left_out(scene, schema);
}

std::string explain_ranks(const Simulation& simulation) {
    const scene::Scene& scene = simulation.scene();
    if (!communicator().several()) return {};
    const sim::Shares& shares = simulation.shares();
    const Partition& cut = shares.cut;
    std::string text = "in parallel on " + std::to_string(communicator().ranks()) + " ranks, ";
    if (shares.nothing_shared()) return text + "the domain cannot be partitioned: every rank computes all of it (replicated work)\n";
    text += std::string("partitioned along ") + (scene.dim() == 2 ? "y" : "z");
    if (cut.empty())
        return text + " into equal numbers of particles; each rank stores and advances its own particles and stores ghost particles\n";
    text += ", subdomains begin at planes";
    for (int rank = 1; rank < cut.ranks(); ++rank) text += (rank == 1 ? " " : ", ") + std::to_string(cut.begin(rank));
    text += simulation.solver().holds_own_planes() ? "; distributed storage: each rank stores and computes its own slab"
                                                   : "; replicated storage: each rank stores the whole grids and computes its own slab";
    if (!shares.replicated_work.empty()) text += "; replicated work: " + scene::text_of(shares.replicated_work);
    return text + "\n";
}

std::string explain_planned_ranks(const scene::Scene& scene, int ranks) {
    const validation::CostEstimate f = validation::estimate_cost(scene);
    return validation::parallel_estimate_text(validation::estimate_in_parallel(scene, f, ranks), f, scene);
}

}  // namespace weir::app
