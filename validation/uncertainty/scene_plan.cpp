#include "validation/uncertainty/scene_plan.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_lock.hpp"
#include "sim/run_id.hpp"
#include "validation/cost/load.hpp"
#include "validation/cost/plan.hpp"
#include "validation/cost/recommend.hpp"
#include "validation/page/text.hpp"
#include "validation/report/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include <unistd.h>

namespace weir::validation {
namespace {

std::vector<std::string> words(const std::string& list) {
    std::vector<std::string> all;
    std::istringstream stream(list);
    for (std::string word; std::getline(stream, word, ',');)
        if (!word.empty()) all.push_back(word);
    return all;
}

std::vector<Wish> wishes_of(const ScenePlanOptions& options, std::size_t quantities) {
    std::vector<Wish> wishes;
    for (const auto& text : options.error) wishes.push_back(parse_wish(text));
    if (wishes.size() == 1) wishes.resize(quantities, wishes.front());
    if (!wishes.empty() && wishes.size() != quantities)
        throw BadInput(fmt::format("--error: give one for all quantities, or one for each of the {}", quantities));
    return wishes;
}

Limits limits_of(const ScenePlanOptions& options) {
    Limits limits;
    if (!options.budget.empty()) limits.budget = parse_seconds(options.budget);
    if (!options.frame.empty()) limits.frame = parse_seconds(options.frame);
    if (!options.time_limit.empty()) limits.time_limit = parse_seconds(options.time_limit);
    return limits;
}

/// The scene's own method, then the others, each once.
std::vector<Method> methods_of(const scene::Scene& scene, const std::string& with, const Solvers& solvers) {
    std::vector<Method> methods{method_of(scene, "", solvers)};
    for (const auto& word : words(with))
        if (std::none_of(methods.begin(), methods.end(), [&](const Method& m) { return m.name == word; }))
            methods.push_back(method_of(scene, word, solvers));
    return methods;
}

/// The last three grids of a whole series, as a band; no value where a grid does not know it.
std::optional<real> series_band(const MethodStudy& study, const Asked& asked) {
    std::vector<GridValue> values;
    for (const GridRun& g : study.grids) {
        values.push_back({g.grid.h, whole_series(g.run, asked)});
        for (const real v : values.back().value)
            if (!std::isfinite(v)) return std::nullopt;
        if (values.back().value.empty()) return std::nullopt;
    }
    if (values.size() < 3) return std::nullopt;
    return band(values, study.method.formal_order).width;
}

/// The whole series tell more than one number: a wave without dispersion may be as high, at other times.
std::optional<Apart> compare(const MethodStudy& own, const MethodStudy& other, const std::vector<Asked>& asked) {
    std::optional<Apart> most;
    for (const Asked& quantity : asked) {
        const auto one = series_band(own, quantity), two = series_band(other, quantity);
        if (!one || !two) continue;
        const Apart apart{
            .distance = distance(whole_series(own.grids.back().run, quantity), whole_series(other.grids.back().run, quantity)),
            .bands = *one + *two,
            .of = quantity.quantity.series,
            .unit = series_named(own.grids.back().run.series, quantity.quantity.series).unit};
        if (!most || apart.z() > most->z()) most = apart;
    }
    return most;
}

/// The series of the scene, read on its coarsest grid, where a simulation takes little memory.
std::vector<RecordedSeries> series_of(const scene::Scene& scene, const Method& method, const Solvers& solvers) {
    const Ladder ladder(scene, method, solvers);
    std::string left_out;
    return series_at_start(ladder.scene(ladder.grid(ladder.coarsest(left_out))), solvers);
}

/// Throws BadInput before a run where a quantity is missing, or its series is none of the scene's.
void check_asked(const std::vector<Asked>& asked, const scene::Scene& scene, const std::vector<RecordedSeries>& series) {
    const real end = scene.number("time.end");
    for (const Asked& a : asked) {
        if (!a.is_metric && a.quantity.kind != Statistic::picture) series_named(series, a.quantity.series);
        for (const real t : {a.quantity.when.first, a.quantity.when.last})
            if (std::isfinite(t) && t > end * (1 + 1e-12))
                throw BadInput(fmt::format("{}: t = {:g} s is after the end of the scene, {:g} s", a.quantity.text, t, end));
    }
    if (!asked.empty()) return;
    std::vector<std::string> names;
    std::string example = "kinetic_energy";  // of a scene without probes
    for (const RecordedSeries& s : series) {
        if (!s.integral && names.empty()) example = s.name;
        if (s.name.find('#') == std::string::npos || s.name.ends_with("#0")) names.push_back(s.name);
    }
    throw BadInput(
        fmt::format("{}: weir plan requires --of, a quantity of this scene, and --error (5%) or --budget (4ms), or both; its probes and "
                    "integrals: {}; such as --of {}.max",
                    scene.file(), fmt::join(names, ", "), example));
}

/// Throws BadInput before a run where an absolute error has another unit than its quantity.
void check_units(const std::vector<Asked>& asked, const std::vector<Wish>& wishes, const std::vector<RecordedSeries>& series) {
    for (std::size_t q = 0; q < wishes.size(); ++q)
        if (!asked[q].is_metric && asked[q].quantity.kind != Statistic::picture)
            absolute(wishes[q], {.unit = unit_of(asked[q].quantity, series_named(series, asked[q].quantity.series).unit)});
}

/// Methods that have become chaotic before the end of the asked times are not compared: their series differ for that reason.
bool comparable(const PlannedMethod& m) { return m.study.solver_fails.empty() && !m.study.chaotic_after; }

/// Largest error of the quantities on a grid, over the wish or over the scale; infinite where one is refused.
real error_of(const ScenePlan& plan, const MethodStudy& study, std::size_t g) {
    real error = 0;
    for (std::size_t q = 0; q < study.quantities.size(); ++q) {
        const QuantityStudy& quantity = study.quantities[q];
        const bool known = quantity.refused.empty() && g < quantity.error.size();
        const real to = plan.wishes.empty() ? quantity.finest().scale : absolute(plan.wishes[q], quantity.finest());
        error = std::max(error, known ? quantity.error[g] / (to > 0 ? to : 1) : infinity);
    }
    return error;
}

bool meets_wishes(const ScenePlan& plan, real error) { return plan.wishes.empty() ? error < infinity : error <= 1; }

}  // namespace

ScenePlan plan_scene(const ScenePlanOptions& options, const Solvers& solvers, const Tell& tell) {
    ScenePlan plan{.file = scene_named(options.scene), .command = plan_line(options), .limits = limits_of(options), .set = options.set};
    const scene::Scene scene = scene::read(plan.file, scene::schemas_of(solvers), options.set);
    plan.name = sim::scene_name(scene), plan.title = scene.text("title");
    const std::vector<Method> methods = methods_of(scene, options.with, solvers);
    if (!options.of.empty()) plan.asked = parse_asked(options.of);
    const auto series = series_of(scene, methods.front(), solvers);
    check_asked(plan.asked, scene, series);
    plan.wishes = wishes_of(options, plan.asked.size());
    check_units(plan.asked, plan.wishes, series);
    std::vector<std::string> metrics;
    for (const Asked& a : plan.asked)
        if (a.is_metric) metrics.push_back(a.quantity.text);
    if (options.keep) plan.folder = options.out.empty() ? std::filesystem::path("out") / plan.name / "plan" : options.out;
    std::optional<output::FolderLock> lock;
    if (options.keep) {
        output::require_writable(plan.folder);
        lock.emplace(plan.folder);
        std::filesystem::create_directories(plan.folder / "runs");
    }
    RunStore store(options.keep ? plan.folder / "runs" : std::filesystem::path(), metrics, plan.limits.time_limit, solvers);
    const Work before = work_so_far();
    for (const Method& method : methods) {
        PlannedMethod planned;
        try {
            planned.study = study_method(scene, method, plan.asked, plan.wishes, plan.limits, store, solvers, tell);
        } catch (const BadInput& wrong) {
            if (plan.methods.empty()) throw;  // the scene's own method: the question is wrong
            planned.study = {.method = method, .solver_fails = wrong.what()};
        }
        if (!plan.methods.empty() && comparable(plan.methods.front()) && comparable(planned))
            planned.apart = compare(plan.methods.front().study, planned.study, plan.asked);
        plan.methods.push_back(std::move(planned));
    }
    plan.others = others_between(before, work_so_far());
    plan.spent = store.seconds();
    plan.take = recommended(plan);
    return plan;
}

std::optional<Recommended> recommended(const ScenePlan& plan) {
    std::optional<Recommended> best;
    real best_error = infinity;
    for (std::size_t m = 0; m < plan.methods.size(); ++m) {
        const MethodStudy& study = plan.methods[m].study;
        if (plan.methods[m].other_equations() || study.quantities.empty()) continue;
        for (std::size_t g = study.grids.size(); g-- > 0;) {  // from fine to coarse, as long as all finer grids meet the wishes
            const real error = error_of(plan, study, g);
            const bool meets = meets_wishes(plan, error);
            if (!meets) break;
            const Recommended choice{m, g, study.seconds_per_frame(g, plan.limits.frame)};
            if (choice.seconds > plan.limits.budget || !study.grids[g].run.balanced) continue;
            const bool better = !best || (plan.wishes.empty() ? error < best_error : choice.seconds < best->seconds);
            if (better) best = choice, best_error = error;
        }
    }
    return best;
}

std::string_view verdict_of(const ScenePlan& plan, std::size_t method, std::size_t grid) {
    const MethodStudy& study = plan.methods[method].study;
    if (plan.take && plan.take->method == method && plan.take->grid == grid) return "recommended";
    if (study.grids[grid].run.failure) return "failed";
    if (plan.methods[method].other_equations()) return "other equations";
    for (const QuantityStudy& quantity : study.quantities)
        if (!quantity.refused.empty()) return "refused";
    if (!meets_wishes(plan, error_of(plan, study, grid))) return "error too large";
    for (std::size_t finer = grid + 1; finer < study.grids.size(); ++finer)
        if (!meets_wishes(plan, error_of(plan, study, finer))) return "error of a finer grid too large";
    if (study.seconds_per_frame(grid, plan.limits.frame) > plan.limits.budget) return "over the budget";
    return study.grids[grid].run.balanced ? "meets the request" : "balance warns";
}

std::string plan_line(const ScenePlanOptions& options) {
    std::string line = "weir plan " + shell_word(options.scene);
    const auto add = [&](const char* option, const std::string& text) {
        if (!text.empty()) line += fmt::format(" {} {}", option, shell_word(text));
    };
    for (const std::string& quantity : options.of) add("--of", quantity);
    for (const std::string& error : options.error) add("--error", error);
    add("--budget", options.budget), add("--frame", options.frame), add("--time-limit", options.time_limit), add("--with", options.with);
    for (const scene::Override& change : options.set) add("--set", change.key + "=" + change.value);
    add("--out", options.out.string());
    return line;
}

std::string run_line(const ScenePlan& plan, const Recommended& choice) {
    const MethodStudy& study = plan.methods[choice.method].study;
    std::string line = "weir run " + shell_word(plan.file);
    std::vector<scene::Override> all = study.method.overrides;  // the user's first
    const auto& grid = study.grids[choice.grid].grid.overrides;
    all.insert(all.end(), grid.begin(), grid.end());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool again =
            std::any_of(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, all.end(), [&](const auto& o) { return o.key == all[i].key; });
        if (!again) line += " --set " + shell_word(all[i].key + "=" + all[i].value);
    }
    return line + " --threads 1";
}

std::string_view left_out_by(std::string_view solver) {
    struct Sentence {
        std::string_view solver, text;
    };
    static constexpr Sentence sentences[] = {
        {"mac", "it has no free surface"},
        {"mac_water", "air is empty, and sheets thinner than a cell are lost"},
        {"tallcell", "it has no friction and no surface tension, and little detail in its tall cells"},
        {"heightfield", "pressure is hydrostatic: waves have no dispersion, and nothing overturns"},
        {"waves", "waves are linear: they do not break, and there are no walls or bodies"},
        {"sph", "the liquid is weakly compressible"},
        {"pbf", "the liquid is compressible by what its iterations leave, and it has no friction by default"}};
    for (const Sentence& s : sentences)
        if (s.solver == solver) return s.text;
    return {};
}

void keep_results(const ScenePlan& plan) {
    if (plan.folder.empty()) return;
    output::write_file(plan.folder / "plan.json", plan_json(plan));
    const std::filesystem::path svg = plan.folder / "plan.svg", page = plan.folder / "index.html";
    try {
        draw_plan(plan, svg);
    } catch (const OutputError&) {
        output::write_file(page, plan_page(plan, ""));
        throw;
    }
    output::write_file(page, plan_page(plan, bytes_of(svg)));
}

int scene_plan_command(const ScenePlanOptions& options, const Solvers& solvers) {
    const bool talk = !options.quiet && isatty(STDERR_FILENO);
    const ScenePlan plan = plan_scene(options, solvers, [&](const std::string& what) {
        if (talk) std::fprintf(stderr, "\r\033[K%s", what.c_str());
    });
    if (talk) std::fprintf(stderr, "\r\033[K");
    std::fputs(plan_text(plan).c_str(), stdout);
    keep_results(plan);
    if (!plan.folder.empty())
        fmt::print("figure: {}\npage: {}\n", (plan.folder / "plan.svg").string(), (plan.folder / "index.html").string());
    return plan.take ? exit_success : exit_claim_failed;
}

}  // namespace weir::validation
