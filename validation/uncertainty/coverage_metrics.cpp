// Metrics of the case error_bars: each is a number of the whole experiment, not of the run that it is measured on. The experiment is that
// of the file in data/ with the name of the run's scene.
#include "core/error.hpp"
#include "sim/registry.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/uncertainty/coverage_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>

namespace weir::validation {
namespace {

struct Experiment {
    CoverageRuns runs{};
    std::vector<CheckedBand> bands{};
};

/// Computed once per program. Of a run that was cut short, the first scene only.
const Experiment& experiment_of(const RunRecord& run) {
    static std::mutex one_at_a_time;
    static std::map<std::pair<std::string, bool>, Experiment> known;
    const std::filesystem::path scene = run.scene->file(), file = scene.parent_path() / "data" / scene.filename();
    if (!std::filesystem::exists(file)) throw BadInput("there is no experiment on error bars: " + file.string());
    const bool whole = run.time >= run.scene->number("time.end") * (1 - 1e-9);
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    const auto [at, missing] = known.try_emplace({file.string(), whole});
    if (missing) {
        at->second.runs = run_coverage_scenes(
            file, sim::registry(), [](const std::string&) {}, whole ? 1000 : 1);
        at->second.bands = check_bands(at->second.runs.quantities);
    }
    return at->second;
}

using Belongs = bool (*)(const KnownQuantity&, const std::string&);

bool of_family(const KnownQuantity& q, const std::string& family) { return q.family == family; }
bool is_added(const KnownQuantity& q, const std::string&) { return q.added; }
bool is_any(const KnownQuantity&, const std::string&) { return true; }

Coverage coverage(const RunRecord& run, Belongs belongs, const std::string& family) {
    const Experiment& all = experiment_of(run);
    return coverage_of(all.bands, [&](const CheckedBand& b) { return belongs(all.runs.quantities[b.quantity], family); });
}

Metric covered(const std::string& name, const std::string& of, Belongs belongs, const std::string& family = "") {
    return {.name = "error_bars." + name,
            .unit = "",
            .doc = "Share of the error bands of weir plan that contain the true error: " + of + ".",
            .quantity = Quantity::value,
            .measure = [=](const RunRecord& run, const Reference&) { return coverage(run, belongs, family).share(); }};
}

real wrong_advice(const RunRecord& run, const Reference&) { return advice_for_all(experiment_of(run).runs.quantities).wrong_share(); }
real median_width(const RunRecord& run, const Reference&) { return coverage(run, is_any, "").median_ratio; }
real unknown_values(const RunRecord& run, const Reference&) { return static_cast<real>(experiment_of(run).runs.unknown.size()); }

/// The share of bands that are at most x times as wide as the error.
Panel distribution(const RunRecord& run, const Reference&) {
    const Experiment& all = experiment_of(run);
    Panel panel{.title = "Width of the bands", .x = {"width over true error", true}, .y = {"share of bands"}};
    for (const char* family : {"mac", "mac_water", "tallcell", "heightfield", "waves", "particles"}) {
        std::vector<real> ratios;
        for (const CheckedBand& b : all.bands)
            if (of_family(all.runs.quantities[b.quantity], family)) ratios.push_back(std::clamp<real>(b.ratio(), 0.01, 1000));
        std::sort(ratios.begin(), ratios.end());
        Curve curve{.label = family, .x = ratios, .y = {}};
        for (std::size_t i = 0; i < ratios.size(); ++i) curve.y.push_back(static_cast<real>(i + 1) / static_cast<real>(ratios.size()));
        if (!ratios.empty()) panel.curves.push_back(std::move(curve));
    }
    panel.marks.push_back({1, "contains the error"});
    return panel;
}

}  // namespace

std::vector<Metric> error_bars_metrics() {
    std::vector<Metric> list{covered("covered", "all", is_any), covered("covered_new", "scenes not used to choose the formula", is_added)};
    list.front().figure = distribution;
    for (const char* family : {"mac", "mac_water", "tallcell", "heightfield", "waves", "particles"})
        list.push_back(covered(fmt::format("covered_{}", family), family, of_family, family));
    list.push_back({.name = "error_bars.wrong_advice",
                    .unit = "",
                    .doc = "Share of the recommendations of weir plan for errors of 1, 2, 5 and 10% whose true error is larger.",
                    .measure = wrong_advice});
    list.push_back({.name = "error_bars.median_width",
                    .unit = "",
                    .doc = "Median of the width of an error band over the true error.",
                    .quantity = Quantity::value,
                    .measure = median_width});
    list.push_back({.name = "error_bars.unknown",
                    .unit = "",
                    .doc = "Number of quantities without a value on some grid of their ladder.",
                    .measure = unknown_values});
    return list;
}

}  // namespace weir::validation
