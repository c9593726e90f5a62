// One run, and what is kept of it.
#include "validation/harness/runner.hpp"

#include "output/frames.hpp"
#include "sim/frame_options.hpp"
#include "sim/loop.hpp"
#include "sim/simulation.hpp"
#include "validation/harness/fitting.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace weir::validation {
namespace {

/// The metrics of the variant's claims, each once.
std::vector<std::string> metrics_of(const Variant& variant) {
    std::vector<std::string> names;
    for (const Criterion& c : variant.accept)
        if (std::find(names.begin(), names.end(), c.metric) == names.end()) names.push_back(c.metric);
    for (const std::string& metric : variant.measured_too)
        if (std::find(names.begin(), names.end(), metric) == names.end()) names.push_back(metric);
    return names;
}

bool is_series(const std::string& metric, const Variant& variant) {
    for (const Criterion& c : variant.accept)
        if (c.metric == metric && c.is_monotone()) return true;
    return false;
}

/// A series to draw and judge: the metric itself, or what stands before its ".drift". What a metric draws itself needs no second picture.
std::optional<Curve> history_of(const RunRecord& record, const std::string& metric, bool judged) {
    if (const Metric* m = find_metric(metric); !judged && m && m->figure) return std::nullopt;
    for (const std::string& name : {metric, metric.substr(0, metric.rfind('.'))}) try {
            return record.series(name);
        } catch (const BadInput&) {
        }
    return std::nullopt;
}

/// Writes the scene's frames, or the first and the last where it asks for none.
class FrameWriter {
public:
    FrameWriter(const std::filesystem::path& folder, const scene::Scene& scene) {
        if (folder.empty() || !sim::frames_unavailable(scene).empty()) return;
        output::FrameOptions options = sim::frame_options(scene);
        options.single_precision = true;  // frames of cases are looked at; metrics read the fields
        frames_.emplace(folder, options);
    }
    void write(const Simulation& simulation, bool at_last = false) {
        if (frames_ && (at_last || simulation.at_frame())) frames_->write(simulation.fields(), simulation.time());
    }

private:
    std::optional<output::Frames> frames_;
};

real mesh_width(const Variant& variant, std::size_t i, const scene::Scene& scene) {
    if (!variant.sweep) return 0;
    if (variant.sweep->key != "grid.cells") return variant.sweep->values[i];
    const auto axis = static_cast<std::size_t>(variant.sweep->axis);
    return scene.root().numbers("grid.size").at(axis) / scene.root().numbers("grid.cells").at(axis);
}

/// A run that was cut off may end before what a metric needs.
real measure_if_there(std::string_view metric, const RunRecord& record, const Reference& reference) {
    try {
        return measure(metric, record, reference);
    } catch (const BadInput&) {
        return std::nan("");
    }
}

void take(RunResult& result, const RunRecord& record, const Reference& reference, const Variant& variant, bool cut) {
    for (const std::string& metric : metrics_of(variant)) {
        result.units[metric] = unit_of(metric, record);
        if (const auto series = history_of(record, metric, is_series(metric, variant))) result.series[metric] = *series;
        if (!is_series(metric, variant)) result.measured[metric] = (cut ? measure_if_there : measure)(metric, record, reference);
        const Metric* m = find_metric(metric);
        if (m && m->figure) result.panels.push_back(fitting(metric, [&] { return m->figure(record, reference); }));
    }
}

}  // namespace

RunWatch::RunWatch(Simulation& simulation, const std::vector<const Metric*>& metrics) : simulation_(&simulation) {
    for (const Metric* m : metrics) {
        if (!m || !m->observe) continue;
        observers_.push_back(m);
        record_.observers.push_back(m->name);
    }
    record_.simulation = std::shared_ptr<Simulation>(std::shared_ptr<void>(), simulation_);
    record_.scene = {record_.simulation, &simulation.scene()};
    remember({}, 0);
}

void RunWatch::remember(const StepReport& report, double seconds) {
    Moment moment{.step = simulation_->steps(), .time = simulation_->time(), .seconds = seconds, .report = report};
    record_.integrals = simulation_->integrals();
    for (const Integral& i : record_.integrals) moment.integrals.push_back(i.value);
    if (!observers_.empty()) {
        const FieldSet fields = simulation_->fields();
        for (const Metric* m : observers_)
            moment.observed.push_back(fitting(m->name, [&] { return m->observe(fields, *record_.scene, moment.time); }));
    }
    record_.history.push_back(std::move(moment));
    record_.time = simulation_->time();
}

void RunWatch::on_step(const StepReport& report, double seconds) {
    record_.seconds += seconds;
    remember(report, seconds);
}

RunRecord& RunWatch::record() {
    record_.fields = simulation_->fields();
    record_.probes = simulation_->probes();
    record_.passes = simulation_->solver().passes().list();
    return record_;
}

RunRecord run_scene(scene::Scene scene, const RunOptions& options, const Solvers& solvers) {
    const auto owner = std::make_shared<Simulation>(std::move(scene), solvers);
    Simulation& simulation = *owner;
    RunWatch watch(simulation, options.observers);
    if (options.at_start) options.at_start(watch.record());
    FrameWriter frames(options.frames, simulation.scene());
    frames.write(simulation);
    double seconds_so_far = 0;
    std::optional<std::string> failed;
    try {
        const std::int64_t steps = options.steps.value_or(sim::StepRange{}.steps);
        sim::advance(simulation, {.steps = steps}, [&](const StepReport& report, double seconds) {
            seconds_so_far += seconds;
            watch.on_step(report, seconds);
            frames.write(simulation, simulation.steps() == steps);
            if (seconds_so_far > options.time_limit)
                throw NumericalFailure("time limit", fmt::format("not finished after {:g} s of computing", options.time_limit));
            return true;
        });
    } catch (const NumericalFailure& failure) {
        const auto step = failure.step >= 0 ? failure.step : simulation.steps();
        failed = fmt::format("step {}, t = {:.6g} s: {}", step, failure.step >= 0 ? failure.time : simulation.time(), failure.what());
    }
    RunRecord record = std::move(watch.record());
    record.simulation = owner;
    record.scene = {owner, &simulation.scene()};
    record.failure = failed;
    return record;
}

Reference make_reference(const std::string& name, const scene::Scene& scene, const std::filesystem::path& case_folder) {
    if (name.empty()) return {};
    std::vector<std::string> known;
    for (const ReferenceKind& kind : references()) {
        if (kind.name == name) return fitting(name, [&] { return kind.make(scene, case_folder / "data"); });
        known.push_back(kind.name);
    }
    throw BadInput(
        fmt::format("{}: unknown reference \"{}\"; known: {}", (case_folder / "case.toml").string(), name, fmt::join(known, ", ")));
}

RunResult run_and_measure(const Case& c, const Variant& variant, std::size_t i, const std::filesystem::path& frames,
                          const Solvers& solvers) {
    RunResult result;
    if (variant.sweep) result.value = variant.sweep->values[i], result.label = fmt::format("{:g}", result.value);
    try {
        scene::Scene scene = scene_of(variant, i, scene::schemas_of(solvers));
        const Reference reference = make_reference(variant.reference, scene, c.folder);
        result.h = mesh_width(variant, i, scene);
        result.formal_order = formal_order(scene.solver(), scene.has("scheme.advection") ? scene.text("scheme.advection") : "");
        RunOptions options{.frames = frames, .time_limit = variant.time_limit, .steps = c.cut};
        for (const std::string& name : metrics_of(variant))
            if (const Metric* m = find_metric(name); m && m->observe) options.observers.push_back(m);
        options.at_start = [&](const RunRecord& start) {
            for (const std::string& name : metrics_of(variant)) check_metric(name, start, reference);
        };
        const RunRecord record = run_scene(std::move(scene), options, solvers);
        result.seconds = record.seconds, result.steps = record.steps(), result.failure = record.failure;
        if (!record.failure) take(result, record, reference, variant, c.cut.has_value());
    } catch (const NumericalFailure& failure) {  // of the initial state
        result.failure = failure.what();
    } catch (const BadInput& wrong) {
        result.failure = wrong.what(), result.bad_input = true;
    }
    return result;
}

CaseResult validate(const Case& c, const std::filesystem::path& out, const Solvers& solvers, const Progress& progress) {
    CaseResult result{.plan = c};
    for (const Variant& variant : c.variants) {
        VariantResult v{.plan = variant, .runs = {}, .verdicts = {}};
        for (std::size_t i = 0; i < variant.runs(); ++i) {
            const auto folder = frames_folder(c, variant, i);
            if (progress) progress(folder.string());
            v.runs.push_back(run_and_measure(c, variant, i, out / folder, solvers));
        }
        if (!c.cut) v.verdicts = judge(variant, v.runs, result.variants);
        result.variants.push_back(std::move(v));
    }
    if (!c.variants.empty() && !c.variants.front().reference.empty())
        result.source =
            make_reference(c.variants.front().reference, scene_of(c.variants.front(), 0, scene::schemas_of(solvers)), c.folder).source;
    return result;
}

void check_case(const Case& c, const Solvers& solvers) {
    for (const Variant& variant : c.variants)
        for (std::size_t i = 0; i < variant.runs(); ++i)
            make_reference(variant.reference, scene_of(variant, i, scene::schemas_of(solvers)), c.folder);
}

}  // namespace weir::validation
