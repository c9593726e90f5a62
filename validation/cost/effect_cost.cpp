#include "validation/cost/effect_cost.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_lock.hpp"
#include "output/machine.hpp"
#include "parallel/partition.hpp"
#include "validation/cost/effect_scene.hpp"
#include "validation/cost/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace weir::validation {
namespace {

constexpr int untimed_pairs = 3, fewest_pairs = 5;
constexpr real usual_strength = 0.1;  // of every effect, in its own unit: moves the fluid visibly and not wildly

double quantile(std::vector<double> list, double part) {
    const auto at = list.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(list.size() - 1));
    std::nth_element(list.begin(), at, list.end());
    return *at;
}

double seconds_of_step(Solver& solver, real dt) {
    const double start = computing_seconds();
    solver.step(dt);
    return computing_seconds() - start;
}

/// Steps with and without, in turns, so that whatever else the machine does meets both.
void time_interleaved(EffectCost& cost, Solver& with, Solver& without, real dt, const EffectCostOptions& options) {
    std::vector<double> ratio, a, b;
    double spent = 0;
    for (int i = -untimed_pairs; i < options.pairs && (i < fewest_pairs || spent < options.enough_seconds); ++i) {
        const double without_it = seconds_of_step(without, dt), with_it = seconds_of_step(with, dt);
        if (i < 0) continue;
        ratio.push_back(with_it / without_it), a.push_back(without_it), b.push_back(with_it);
        spent += without_it + with_it;
    }
    cost.ms_without = 1e3 * quantile(a, 0.5), cost.ms_with = 1e3 * quantile(b, 0.5);
    cost.ratio = quantile(ratio, 0.5);
    cost.spread = 0.5 * (quantile(ratio, 0.75) - quantile(ratio, 0.25));
}

EffectCost measure_effect(const scene::SolverKind& kind, int dim, int cells, const std::string& effect, const EffectCostOptions& options) {
    EffectCost cost{.solver = kind.schema.name, .dim = dim, .cells = cells, .effect = effect};
    try {
        const auto without = kind.make(plain_scene(kind, dim, cells, {effect}), {});
        const auto with = kind.make(scene_with(kind, dim, cells, {effect}, usual_strength), {});
        time_interleaved(cost, *with, *without, 0.2 * std::min({with->advised_dt(), without->advised_dt(), 1.0}), options);
        cost.bytes_without = without->bytes(), cost.bytes_with = with->bytes();
        for (const EffectPlan& plan : with->effects()) {
            cost.inside = plan.inside;
            cost.fields = plan.fields;
            cost.fields.insert(cost.fields.end(), plan.scratch.begin(), plan.scratch.end());
        }
    } catch (const std::runtime_error& failed) {  // a step that fails, a scene that is refused
        cost.failure = failed.what();
    }
    return cost;
}

double added(const EffectCost& c) { return static_cast<double>(c.bytes_with) - static_cast<double>(c.bytes_without); }

}  // namespace

std::vector<EffectCost> measure_effects(const std::vector<scene::SolverKind>& kinds, const EffectCostOptions& options,
                                        const std::function<void(const std::string&)>& progress) {
    std::vector<EffectCost> list;
    for (const auto& kind : kinds)
        for (const int dim : kind.schema.dims)
            for (const auto& effect : kind.schema.effects) {
                if (!options.solver.empty() && kind.schema.name != options.solver) continue;
                if (progress) progress(fmt::format("{} {}D {}", kind.schema.name, dim, effect.name));
                list.push_back(measure_effect(kind, dim, dim == 2 ? options.cells_2d : options.cells_3d, effect.name, options));
            }
    return list;
}

std::string effects_csv(const std::vector<EffectCost>& list) {
    std::string s =
        "# The same step with an effect and without it, taken in turns; medians. spread: half the distance of the ratio's quartiles.\n"
        "solver,dim,cells,effect,inside,ms_without,ms_with,ratio,spread,bytes_without,bytes_with,fields,failure\n";
    for (const EffectCost& c : list) {
        std::string failure = c.failure.substr(0, c.failure.find('\n'));
        std::replace(failure.begin(), failure.end(), ',', ';');
        s += fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.4f},{:.4f},{},{},{},{}\n", c.solver, c.dim, c.cells, c.effect, c.inside,
                         c.ms_without, c.ms_with, c.ratio, c.spread, c.bytes_without, c.bytes_with, fmt::join(c.fields, " "), failure);
    }
    return s;
}

std::string effects_markdown(const std::vector<EffectCost>& list, const std::string& machine) {
    std::string s =
        "# Cost of each effect\n\nThis page is written by `weir cost --effects --publish`. Steps with and without the effect are measured "
        "alternately with the same time step; the table gives medians of the times and of their ratios. An effect that a scene does not "
        "name costs nothing (tests/effects); an effect \"inside\" a pass is a term of that pass.\n\n"
        "| solver | dim | cells | effect | ms without | ms with | ratio | +kB | fields | |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for (const EffectCost& c : list)
        s += c.failure.empty() ? fmt::format("| {} | {} | {}^{} | {} | {:.3f} | {:.3f} | {:.2f} ± {:.2f} | {:.1f} | {} | {} |\n", c.solver,
                                             c.dim, c.cells, c.dim, c.effect, c.ms_without, c.ms_with, c.ratio, c.spread, added(c) / 1e3,
                                             fmt::join(c.fields, ", "), c.inside.empty() ? "" : "inside " + c.inside)
                               : fmt::format("| {} | {} | {}^{} | {} | failed: {} | | | | | |\n", c.solver, c.dim, c.cells, c.dim, c.effect,
                                             c.failure.substr(0, c.failure.find('\n')));
    return s + "\nAll values: [effects.csv](effects.csv). " + machine + "\n";
}

int effects_command(const EffectCostOptions& options, const std::vector<std::filesystem::path>& folders, bool quiet) {
    for (const auto& folder : folders) output::require_writable(folder);
    const output::FolderLock lock(folders.at(0));
    const bool talk = !quiet && isatty(STDERR_FILENO);
    const auto list = measure_effects(sim::registry(), options, [&](const std::string& what) {
        if (talk) std::fprintf(stderr, "\r\033[K%s", what.c_str());
    });
    if (talk) std::fprintf(stderr, "\r\033[K");
    if (list.empty()) throw BadInput("there is no solver with effects named " + options.solver);
    fmt::print("{:10} {:3} {:21} {:>10} {:>10} {:>7} {:>7} {:>9}  {}\n", "solver", "dim", "effect", "ms without", "ms with", "ratio",
               "spread", "+kB", "fields");
    for (const EffectCost& c : list)
        fmt::print("{:10} {}D  {:21} {:>10.3f} {:>10.3f} {:>7.2f} {:>7.2f} {:>9.1f}  {}{}\n", c.solver, c.dim, c.effect, c.ms_without,
                   c.ms_with, c.ratio, c.spread, added(c) / 1e3,
                   c.failure.empty() ? fmt::format("{}", fmt::join(c.fields, ", ")) : c.failure,
                   c.inside.empty() ? "" : "inside " + c.inside);
    const output::Machine machine = output::this_machine();
    const std::string where = fmt::format("{} thread(s), commit {}, on {}, {}, {}.", threads(), machine.commit, machine.processor,
                                          machine.system, machine.compiler);
    for (const auto& folder : folders) {
        output::write_file(folder / "effects.csv", effects_csv(list));
        output::write_file(folder / "effects.md", effects_markdown(list, where));
    }
    return std::any_of(list.begin(), list.end(), [](const EffectCost& c) { return !c.failure.empty(); }) ? exit_claim_failed : exit_success;
}

}  // namespace weir::validation
