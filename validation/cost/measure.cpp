#include "validation/cost/measure.hpp"

#include "backend/device.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "sim/simulation.hpp"
#include "validation/cost/load.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

std::vector<std::string> metrics_of(const Study& study) {
    std::vector<std::string> names = {study.error};
    names.insert(names.end(), study.also.begin(), study.also.end());
    return names;
}

RunOptions run_options(const Study& study, const Variant& method, const MeasureOptions& options) {
    RunOptions run{.time_limit = std::min(options.time_limit, method.time_limit)};
    for (const std::string& name : metrics_of(study))
        if (const Metric* m = find_metric(name); m && m->observe) run.observers.push_back(m);
    return run;
}

void take_errors(CostPoint& point, const Study& study, const RunRecord& record, const Reference& reference) {
    point.error = std::abs(measure(study.error, record, reference));
    for (const std::string& name : study.also) try {
            point.also[name] = measure(name, record, reference);
        } catch (const BadInput&) {  // this solver does not have it: the cell stays empty
        }
    if (!std::isfinite(point.error))
        point.failure = fmt::format("{} is not a number", study.error);
    else if (point.error > study.diverged_above)
        point.failure = fmt::format("diverged by step {}: {} = {:.3g} ({})", record.steps(), study.error, point.error, study.diverged_why);
}

/// Which device the scene's backend is. Nothing where it is the processor itself, or where there is no such device: the run says so.
void take_device(CostPoint& point, const scene::Scene& scene) {
    if (!scene.has("scheme.backend")) return;
    const backend::Choice choice = backend::parse_choice(scene.text("scheme.backend"));
    if (choice.kind != backend::Choice::Kind::opencl) return;
    const auto devices = backend::devices();
    const auto number = static_cast<std::size_t>(choice.device);
    if (number >= devices.size()) return;
    const backend::DeviceInfo& d = devices[number];
    point.device = fmt::format("{} ({}, {} units), {}, driver {}", d.name, d.kind, d.units, d.version, d.driver);
    point.device_kind = d.kind;
}

bool wants_more(const MeasureOptions& options, int done, double spent) {
    if (done == 0) return true;
    if (done < options.repeats) return spent < options.enough_seconds;
    return options.repeats > 1 && done < options.most_repeats && spent < options.least_seconds;
}

CostPoint measure_point(const Study& study, const Variant& method, std::size_t i, const MeasureOptions& options, const Solvers& solvers,
                        StudyResult& result) {
    const ThreadsScope own(method.threads);
    const sim::NoThreadTrials no_trials;
    CostPoint point{.method = method.name, .threads = threads()};
    if (method.sweep) point.setting = fmt::format("{:g}", method.sweep->values[i]);
    const auto schemas = scene::schemas_of(solvers);
    try {
        const Work before = work_so_far();
        std::vector<Timing> timings;
        double spent = 0;
        while (wants_more(options, static_cast<int>(timings.size()), spent)) {
            scene::Scene scene = scene_of(method, i, schemas);
            take_device(point, scene);
            const Reference reference = make_reference(method.reference, scene, study.folder);
            result.source = reference.source;
            RunOptions run = run_options(study, method, options);
            run.at_start = [&](const RunRecord& start) { check_metric(study.error, start, reference); };
            const RunRecord record = run_scene(std::move(scene), run, solvers);
            point.threads = record.simulation->threads(), point.steps = record.steps(), point.bytes = record.simulation->solver().bytes();
            if (record.failure) {
                point.failure = (record.seconds > run.time_limit ? "stopped at " : "diverged at ") + *record.failure;
                break;
            }
            result.unit = unit_of(study.error, record);
            timings.push_back(timing_of(record)), spent += record.seconds;
            if (timings.size() == 1) take_errors(point, study, record, reference);  // repeats give the same numbers bit for bit
        }
        point.others = others_between(before, work_so_far());
        if (!timings.empty()) take_times(point, std::move(timings));
    } catch (const NumericalFailure& failure) {  // of the initial state
        point.failure = std::string("diverged at the start: ") + failure.what();
    } catch (const BadInput& wrong) {  // no such device, or a scene that this backend cannot run
        point.failure = std::string(CostPoint::not_run) + wrong.what();
    }
    return point;
}

}  // namespace

void take_times(CostPoint& point, std::vector<Timing> runs) {
    std::sort(runs.begin(), runs.end(), [](const Timing& a, const Timing& b) { return a.computing < b.computing; });
    const Timing& median = runs[(runs.size() - 1) / 2];
    point.repeats = static_cast<int>(runs.size());
    point.seconds_per_second = median.seconds_per_second();
    point.ms_per_step = median.ms_per_step();
    if (median.computing > 0) point.spread = (runs.back().computing - runs.front().computing) / median.computing;
}

Timing timing_of(const RunRecord& record) {
    Timing t;
    const std::size_t from = record.history.size() > 2 ? 2 : 1;  // entry 0 is the initial state
    for (std::size_t i = from; i < record.history.size(); ++i)
        t.computing += record.history[i].seconds, t.simulated += record.history[i].report.dt, ++t.steps;
    return t;
}

StudyResult measure_study(const Study& study, const MeasureOptions& options, const Solvers& solvers,
                          const std::function<void(const std::string&)>& progress) {
    StudyResult result{.study = study, .source = {}, .unit = {}, .threads = threads(), .points = {}};
    for (const Variant& method : study.methods)
        for (std::size_t i = 0; i < method.runs(); ++i) {
            if (progress) progress(fmt::format("{} {} {}", study.name, method.name, i + 1));
            result.points.push_back(measure_point(study, method, i, options, solvers, result));
        }
    mark_front(result.points, study);
    return result;
}

std::string CostPoint::name() const {
    std::string s = setting.empty() ? method : method.empty() ? setting : method + " " + setting;
    if (!device_kind.empty()) s += " (on " + device_kind + ")";
    return s;
}

std::map<std::string, real> numbers_of(const StudyResult& result) {
    std::map<std::string, real> numbers;
    for (const CostPoint& p : result.points) {
        if (!p.was_run() || !p.device_kind.empty()) continue;
        const std::string place = p.name().empty() ? "" : p.name() + ": ";
        numbers[place + "bytes"] = static_cast<real>(p.bytes);
        if (p.failure) continue;
        numbers[place + result.study.error] = p.error;
        for (const auto& [metric, x] : p.also) numbers[place + metric] = x;
    }
    return numbers;
}

void mark_front(std::vector<CostPoint>& points, const Study& study) {
    constexpr real alike = 1.05;
    const auto beats = [&](const CostPoint& a, const CostPoint& b) {
        const double pa = a.price(study.price), pb = b.price(study.price);
        const real ea = study.told(a.error), eb = study.told(b.error);
        return !a.failure && ((pa < pb && ea <= alike * eb) || (pa == pb && ea < eb));
    };
    for (CostPoint& p : points)
        p.on_front = !p.failure && std::none_of(points.begin(), points.end(), [&](const CostPoint& q) { return beats(q, p); });
}

}  // namespace weir::validation
