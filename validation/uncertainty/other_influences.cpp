#include "validation/uncertainty/other_influences.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

constexpr real twin_change = 1e-6;
constexpr real parted = 0.05;    // of the range of the series
constexpr int averages = 30;     // windows of a series, to compare twins
constexpr int parts = 6;         // windows of a mean, for its band
constexpr real student = 2.571;  // two-sided 95% of Student's t with five degrees of freedom
constexpr int seeds = 3;
constexpr std::size_t few_grids = 4;  // of a cheap ladder: coarse grids may damp what finer ones show

real largest_of(const Curve& c) {
    real largest = 0;
    for (const real y : c.y) largest = std::max(largest, std::abs(y));
    return largest;
}

/// A run with one more change; no value where the solver does not accept it or the run fails.
const RecordedRun* changed_run(const Ladder& ladder, const Grid& grid, std::vector<scene::Override> more,
                               const std::vector<scene::Override>& changes, RunStore& store) {
    more.insert(more.end(), changes.begin(), changes.end());
    try {
        const RecordedRun& run = store.run(ladder.scene(grid, more));
        return run.failure ? nullptr : &run;
    } catch (const BadInput&) {
        return nullptr;
    }
}

/// Distance of a quantity of two runs on the same grid; NaN where one does not know it.
real change_of(const QuantityStudy& quantity, std::size_t number, const RecordedRun& run) {
    const Value value = value_of(run, quantity.asked, number), &coarsest = quantity.values.front();
    if (!value.unknown.empty() || !coarsest.unknown.empty() || value.samples.size() != coarsest.samples.size()) return std::nan("");
    return distance(value.samples, coarsest.samples);
}

void halve_step(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store) {
    const GridRun& coarsest = study.grids.front();
    const bool fixed = ladder.scene(coarsest.grid).has("time.dt");
    const scene::Override half{fixed ? "time.dt" : "time.max_dt", fmt::format("{:.9g}", 0.5 * coarsest.run.mean_dt)};
    const RecordedRun* run = changed_run(ladder, coarsest.grid, more, {half}, store);
    if (!run) return;
    for (std::size_t q = 0; q < study.quantities.size(); ++q)
        if (const real change = change_of(study.quantities[q], q, *run); std::isfinite(change)) study.quantities[q].step = change;
}

/// Twice the standard deviation over the seeds.
void vary_seeds(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store) {
    const scene::Scene scene = ladder.scene(study.grids.front().grid);
    if (!scene.has("scheme.seed")) return;
    std::vector<const RecordedRun*> runs;
    for (int s = 1; s < seeds; ++s)
        if (const auto* run = changed_run(ladder, study.grids.front().grid, more,
                                          {{"scheme.seed", fmt::format("{}", scene.integer("scheme.seed") + s)}}, store))
            runs.push_back(run);
    for (std::size_t q = 0; q < study.quantities.size(); ++q) {
        real sum = 0;
        for (const auto* run : runs) {
            const real change = change_of(study.quantities[q], q, *run);
            sum += std::isfinite(change) ? change * change : 0;
        }
        // the difference of two seeds has twice the variance of one
        if (!runs.empty()) study.quantities[q].seeds = 2 * std::sqrt(sum / (2 * static_cast<real>(runs.size())));
    }
}

/// The scene changed by one part in a million: gravity where there is any, else whatever sets the time step.
std::vector<scene::Override> changes_for_twin(const scene::Scene& scene, std::string& what) {
    const scene::Table* gravity = scene.effect("gravity");
    if (gravity && gravity->has("g") && size_of(gravity->numbers("g")) > 0) {
        std::vector<std::string> g;
        for (const double component : gravity->numbers("g")) g.push_back(fmt::format("{:.15g}", component * (1 + twin_change)));
        what = "gravity changed by one millionth";
        return {{"effects.gravity.g", fmt::format("[{}]", fmt::join(g, ", "))}};
    }
    what = "the time step changed by one millionth";
    std::vector<scene::Override> changes;
    for (const char* key : {"time.dt", "time.max_dt", "time.cfl"})
        if (scene.has(key) && std::isfinite(scene.number(key)))
            changes.push_back({key, fmt::format("{:.15g}", scene.number(key) * (1 - twin_change))});
    return changes;
}

void run_twin(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store) {
    const GridRun& second = study.grids.at(study.grids.size() - (study.grids.size() > few_grids ? 2 : 1));
    std::string what;
    const auto changes = changes_for_twin(ladder.scene(second.grid), what);
    const RecordedRun* twin = changed_run(ladder, second.grid, more, changes, store);
    if (!twin) return;
    for (const QuantityStudy& quantity : study.quantities) {
        if (quantity.asked.is_metric || quantity.asked.quantity.kind == Statistic::picture) continue;
        study.twin = what;
        const auto& name = quantity.asked.quantity.series;
        const RecordedSeries& series = series_named(second.run.series, name);
        const real least = std::max(round_off * largest_of_unit(second.run, series.unit), no_variation * largest_of(series.curve));
        const auto time = time_of_parting(series.curve, series_named(twin->series, name).curve, least);
        if (time && (!study.chaotic_after || *time < *study.chaotic_after)) study.chaotic_after = time;
    }
}

/// Keys of the model that stay as they are on every grid.
void double_the_rest(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store) {
    const Grid& coarsest = study.grids.front().grid;
    const scene::Scene scene = ladder.scene(coarsest);
    for (const char* key : {"scheme.iterations", "scheme.sound_speed"}) {
        if (!scene.has(key)) continue;
        const bool whole = std::string_view(key) == "scheme.iterations";
        const std::string now = whole ? fmt::format("{}", scene.integer(key)) : fmt::format("{:g}", scene.number(key));
        const std::string doubled = whole ? fmt::format("{}", 2 * scene.integer(key)) : fmt::format("{:.15g}", 2 * scene.number(key));
        const RecordedRun* run = changed_run(ladder, coarsest, more, {{key, doubled}}, store);
        for (std::size_t q = 0; q < study.quantities.size(); ++q) {
            QuantityStudy& quantity = study.quantities[q];
            const real change = run ? change_of(quantity, q, *run) : std::nan("");
            quantity.not_refined.push_back(std::isfinite(change) ? fmt::format("{} = {}: twice as much moves it by {}", key, now,
                                                                               text_with_unit(change, quantity.values.front().unit, change))
                                                                 : fmt::format("{} = {}: not known with twice as much", key, now));
        }
    }
    if (scene.has("scheme.support"))
        for (QuantityStudy& quantity : study.quantities)
            quantity.not_refined.push_back(fmt::format("scheme.support = {:g} spacings", scene.number("scheme.support")));
}

/// Whether the asked times lie before the flow is chaotic.
bool before(const QuantityStudy& quantity, const MethodStudy& study, real t) {
    const NamedQuantity& asked = quantity.asked.quantity;
    if (asked.is_time()) {
        for (const Value& v : quantity.values)
            if (!v.samples.empty() && v.samples[0] > t) return false;
        return true;
    }
    const real last = std::min(asked.when.last, study.grids.back().run.end);
    if (asked.kind != Statistic::max && asked.kind != Statistic::min) return last <= t;
    NamedQuantity time = asked;  // an extremum counts where it lies
    time.kind = asked.kind == Statistic::max ? Statistic::time_of_max : Statistic::time_of_min;
    for (const GridRun& g : study.grids)
        if (!(statistic_of(series_named(g.run.series, asked.series).curve, time) <= t)) return false;
    return true;
}

/// Half the width of the 95% interval of a mean, from the means of its six parts, plus the spread over the grids.
real band_of_mean(const QuantityStudy& quantity, const MethodStudy& study) {
    const NamedQuantity& asked = quantity.asked.quantity;
    const Curve part = within(series_named(study.grids.back().run.series, asked.series).curve, asked.when);
    std::vector<real> means;
    for (int i = 0; i < parts; ++i) {
        NamedQuantity window = asked;
        const real length = (part.x.back() - part.x.front()) / parts;
        window.when = {part.x.front() + length * i, part.x.front() + length * (i + 1)};
        means.push_back(statistic_of(part, window));
    }
    real mean = 0, square = 0, low = infinity, high = -infinity;
    for (const real m : means) mean += m / parts;
    for (const real m : means) square += (m - mean) * (m - mean);
    for (const Value& v : quantity.values) low = std::min(low, v.samples.at(0)), high = std::max(high, v.samples.at(0));
    return student * std::sqrt(square / (parts - 1) / parts) + (high - low);
}

}  // namespace

std::optional<real> time_of_parting(const Curve& one, const Curve& twin, real least) {
    if (one.x.size() < 2 || twin.x.size() < 2) return std::nullopt;
    const real first = one.x.front(), last = std::min(one.x.back(), twin.x.back());
    const auto [low, high] = std::minmax_element(one.y.begin(), one.y.end());
    const real range = *high - *low, limit = parted * range;
    if (!(range > least)) return std::nullopt;
    const NamedQuantity mean{.kind = Statistic::mean};
    for (int i = 0; i < averages && limit > 0; ++i) {
        NamedQuantity window = mean;
        window.when = {first + (last - first) * i / averages, first + (last - first) * (i + 1) / averages};
        if (std::abs(statistic_of(one, window) - statistic_of(twin, window)) > limit) return window.when.first;
    }
    return std::nullopt;
}

void study_coarsest_grid(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store,
                         const Tell& tell) {
    tell(fmt::format("{}: time step, seeds, keys that are not refined", study.method.name));
    halve_step(study, ladder, more, store);
    vary_seeds(study, ladder, more, store);
    double_the_rest(study, ladder, more, store);
}

void study_chaos(MethodStudy& study, const Ladder& ladder, const std::vector<scene::Override>& more, RunStore& store, const Tell& tell) {
    tell(fmt::format("{}: chaos", study.method.name));
    run_twin(study, ladder, more, store);
}

bool refuse_after_chaos(MethodStudy& study) {
    if (!study.chaotic_after) return false;
    bool refused = false;
    for (QuantityStudy& quantity : study.quantities) {
        if (!quantity.band || quantity.asked.is_metric || before(quantity, study, *study.chaotic_after)) continue;
        if (quantity.asked.quantity.is_point()) {
            quantity.refused = fmt::format(
                "chaotic after t = {:.3g} s: with {} the value differs by more than 5% of its range. Ask for mean or "
                "rms over a window, or for an earlier time",
                *study.chaotic_after, study.twin);
            refused = true;
            continue;
        }
        quantity.width = band_of_mean(quantity, study);
        quantity.error.assign(quantity.values.size(), quantity.width);
        const bool wide = quantity.width > widest_band * quantity.finest().scale;
        quantity.refused =
            wide ? fmt::format("chaotic, and the mean over this window is known to {:.0f}% of its range only: take a longer window",
                               100 * quantity.width / quantity.finest().scale)
                 : "";
    }
    return refused;
}

}  // namespace weir::validation
